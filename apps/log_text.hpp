// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "hmt/submap/log/log_check.hpp"

namespace hmt::apps {

/// What is in a log, without its findings.
nlohmann::ordered_json log_json(const submap::LogSummary& summary);
std::string log_text(const submap::LogSummary& summary);

}  // namespace hmt::apps
