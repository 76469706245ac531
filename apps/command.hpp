// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace CLI {
class App;
}

namespace hmt::apps {

/// Exit codes of the program.
enum ExitCode { kDone = 0, kFailed = 1, kUsage = 2, kDoneWithLosses = 3, kInterrupted = 130 };

enum class ProgressMode { automatic, plain, none };

/// Options that every command has.
struct Globals {
  bool json = false;     ///< one JSON object on stdout, logs on stderr
  int threads = 0;       ///< resolved to >= 1 before a command runs
  bool verbose = false;  ///< messages with the time of day
  bool quiet = false;
  ProgressMode progress = ProgressMode::automatic;
};

/// What a command does once its options are parsed; returns an ExitCode.
using Action = std::function<int(const Globals&)>;

/// One row of the table in main.cpp: `add` declares the options of the command and returns its
/// action.
struct Command {
  const char* name;
  const char* help;
  Action (*add)(CLI::App& command);
};

}  // namespace hmt::apps
