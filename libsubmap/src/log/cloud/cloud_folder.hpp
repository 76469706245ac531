// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hmt/submap/log/log_reader.hpp"
#include "stamped_poses_file.hpp"

namespace hmt::submap {

/// Reads a folder of clouds in the robot frame, one file an observation, in natural order of their
/// names, with the odometry of another file: line N is of cloud N. Without that file the odometry
/// stands still, which is how a log tells that it has none.
///
/// Stamps are those of the odometry file, or of `times.txt` in the folder (one a line, as KITTI has
/// it), or absent.
class CloudFolder : public LogReader {
 public:
  CloudFolder(const std::filesystem::path& folder, const LogOptions& options);

  std::optional<Observation> next() override;
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return bytes_read_; }
  int64_t bytes_total() const override { return bytes_total_; }
  Space space() const override { return Space::se3; }

  /// Whether a folder holds clouds.
  static bool is(const std::filesystem::path& folder);

 private:
  void pair_with_odometry(const std::string& odometry_file);
  void read_times(const std::filesystem::path& times);
  std::optional<Observation> observation(size_t cloud);

  std::vector<std::filesystem::path> clouds_;
  std::vector<PoseLine> poses_;  ///< of the clouds
  size_t next_ = 0;
  LogReport report_;
  int64_t bytes_read_ = 0;
  int64_t bytes_total_ = 0;
};

}  // namespace hmt::submap
