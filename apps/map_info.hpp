// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "command.hpp"

namespace hmt::apps {

/// Prints what is in a map file, finished or not.
int map_info(const std::string& path, const Globals& globals);

}  // namespace hmt::apps
