// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>

#include "command.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::apps {

/// Threads, messages and progress as the user asked for them: messages and progress go to stderr,
/// progress as one rewritten line in a terminal and as a line every few seconds in a pipe. Ctrl-C
/// sets Run::stop.
submap::Run make_run(const Globals& globals);

/// With --json the object as one line on stdout, otherwise `text`.
void print_result(const Globals& globals, const nlohmann::ordered_json& object,
                  const std::string& text);

}  // namespace hmt::apps
