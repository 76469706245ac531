// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "hmt/submap/export/trajectory.hpp"

namespace hmt::apps {

/// True for an SQLite database that tells which program made it, so not for a ROS 2 bag; false
/// where there is no such file.
bool is_map_file(const std::filesystem::path& path);

/// T_world_robot of every observation of a map, or the poses of a TUM file; told apart by content.
std::vector<submap::StampedPose> load_trajectory(const std::filesystem::path& path);

}  // namespace hmt::apps
