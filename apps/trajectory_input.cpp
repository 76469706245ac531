// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_input.hpp"

#include <fstream>
#include <string_view>

#include "hmt/submap/map/hybrid_map.hpp"
#include "hmt/submap/map/map_file.hpp"

namespace hmt::apps {
bool is_map_file(const std::filesystem::path& path) {
  constexpr std::string_view kMagic = "SQLite format 3";
  // [SQLite file format, 1.3]; ROS 2 bags are SQLite databases, too, and leave it zero.
  constexpr size_t kApplicationId = 68;
  std::string head(kApplicationId + 4, '\0');
  std::ifstream(path, std::ios::binary)
      .read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.starts_with(kMagic) && head.substr(kApplicationId) != std::string(4, '\0');
}

std::vector<submap::StampedPose> load_trajectory(const std::filesystem::path& path) {
  return is_map_file(path) ? submap::stamped_trajectory(submap::MapFile::open(path).load_map())
                           : submap::read_tum(path);
}

}  // namespace hmt::apps
