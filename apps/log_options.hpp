// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/log/log_reader.hpp"

namespace CLI {
class App;
}

namespace hmt::apps {

/// What the argument LOG may be, for its help text.
inline constexpr const char* kLogFormats =
    "CARMEN (plain, gz, bz2, zst), ROS 1 bag, MCAP, ROS 2 sqlite3 bag, a folder of bags or of "
    "clouds (pcd, ply, bin), Victoria Park text, an MRCLAM folder";

/// Declares the options that choose what of a log is read; they are written to `options`.
void add_log_options(CLI::App& command, submap::LogOptions& options);

}  // namespace hmt::apps
