// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "hmt/graph/pose.hpp"
#include "hmt/submap/map/hybrid_map.hpp"

namespace hmt::submap {

/// One pose of a trajectory.
struct StampedPose {
  double stamp_s = 0;
  graph::Pose T_world_robot;

  bool operator==(const StampedPose&) const = default;
};

/// Reads a TUM file: `stamp x y z qx qy qz qw` a line, or `stamp x y heading` in the plane (as the
/// ground truth of MRCLAM), metres and radians, `#` starts a comment; plain or compressed (gz, bz2,
/// zst). Throws InputError naming file and line for a line that is not so, for
/// a quaternion of length zero and for a file without poses.
std::vector<StampedPose> read_tum(const std::filesystem::path& path);

/// Writes a TUM file, all or nothing. Stamps have as many decimals as give the same number when
/// read again, six at least; poses have nine.
void write_tum(const std::filesystem::path& path, std::span<const StampedPose> trajectory);

/// T_world_robot of every observation of the map with the log's own stamps, in the order of the
/// log.
std::vector<StampedPose> stamped_trajectory(const HybridMap& map);

}  // namespace hmt::submap
