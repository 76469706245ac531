// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "command.hpp"

// One function a command, each in the .cpp of its name; the table is in main.cpp.
namespace hmt::apps {

Action add_loops(CLI::App& command);
Action add_route(CLI::App& command);
Action add_map(CLI::App& command);
Action add_export(CLI::App& command);
Action add_check(CLI::App& command);
Action add_info(CLI::App& command);
Action add_evaluate(CLI::App& command);
Action add_optimize(CLI::App& command);
Action add_partition(CLI::App& command);
Action add_compare(CLI::App& command);
Action add_simulate(CLI::App& command);

}  // namespace hmt::apps
