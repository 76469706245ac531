// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "hmt/submap/log/log_reader.hpp"

namespace hmt::submap {

/// One line of a file of poses.
struct PoseLine {
  std::optional<double> stamp_s;  ///< where the format has stamps
  std::optional<Pose> T;          ///< nothing where the line holds no pose
};

/// Reads poses line by line, without comments and empty lines: TUM (`stamp x y z qx qy qz qw`) or
/// KITTI (the upper three rows of the 4x4 matrix, row by row), told by the first line. Lines that
/// are no pose keep their place and are counted in `report`. Throws InputError for a file of
/// neither format.
std::vector<PoseLine> read_pose_lines(const std::filesystem::path& path, LogReport& report);

/// Reads one stamp, in seconds, a line; throws InputError for a line that is none.
std::vector<double> read_stamps(const std::filesystem::path& path);

}  // namespace hmt::submap
