// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace hmt::submap {

/// How far a long stage has come.
struct Progress {
  std::string_view stage;
  double done = 0;
  double total = 0;  ///< 0 if unknown
};

/// What every stage gets besides its input and options: threads, and where its messages go. The
/// library itself never prints. All callbacks may be empty; they are called from one thread at a
/// time.
struct Run {
  int threads = 1;
  std::function<void(const Progress&)> progress;
  std::function<void(const std::string&)> info;
  std::function<void(const std::string&)> detail;  ///< one a step rather than one a stage
  std::function<void(const std::string&)> warn;
  /// Asked now and then; where it returns true the stage throws Interrupted.
  std::function<bool()> stop;

  void report(const Progress& p) const {
    if (progress) progress(p);
  }
  void log_info(const std::string& text) const {
    if (info) info(text);
  }
  void log_detail(const std::string& text) const {
    if (detail) detail(text);
  }
  void log_warning(const std::string& text) const {
    if (warn) warn(text);
  }
  bool stop_requested() const { return stop && stop(); }
};

/// The user asked to stop; what is committed in the map file stays and the same command goes on
/// from there.
struct Interrupted {};

}  // namespace hmt::submap
