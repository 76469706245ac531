// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hmt/submap/log/log_check.hpp"
#include "hmt/submap/log/recording_summary.hpp"

namespace hmt::apps {

/// What is in a log, without its findings.
nlohmann::ordered_json log_json(const submap::LogSummary& summary);
std::string log_text(const submap::LogSummary& summary);

/// The topics of a recording.
nlohmann::ordered_json topics_json(const std::vector<submap::TopicSummary>& topics);
std::string topics_text(const std::vector<submap::TopicSummary>& topics);

}  // namespace hmt::apps
