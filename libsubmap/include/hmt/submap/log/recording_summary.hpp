// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hmt/submap/log/log_reader.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// One topic of a recording of ROS. Times are those of receipt, by the recorder's clock.
struct TopicSummary {
  std::string name;
  std::string type;  ///< as it was recorded
  int64_t messages = 0;
  double first_s = 0;
  double last_s = 0;
  double rate_hz = 0;               ///< mean; 0 for fewer than two messages
  std::vector<std::string> frames;  ///< of scans, odometry and transforms, sorted; at most 100

  bool operator==(const TopicSummary&) const = default;
};

/// What a recording holds, whether a map can be made of it or not.
struct RecordingSummary {
  std::vector<TopicSummary> topics;  ///< by name
  LogReport report;                  ///< damage of the file, and messages that are damaged

  bool operator==(const RecordingSummary&) const = default;
};

/// Reads a whole recording of ROS, a file or a folder (see open_log); nothing where the path is
/// none, so for a CARMEN log or a map. Throws InputError where it cannot be read at all.
std::optional<RecordingSummary> summarize_recording(const std::filesystem::path& path,
                                                    const Run& run);

}  // namespace hmt::submap
