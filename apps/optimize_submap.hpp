// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "command.hpp"

namespace hmt::apps {

/// `hmtmap optimize MAP --submap N`.
int optimize_one_submap(const std::string& map, int submap, const Globals& globals);

}  // namespace hmt::apps
