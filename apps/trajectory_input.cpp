// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "trajectory_input.hpp"

#include <fstream>
#include <string_view>

#include "hmt/submap/map/hybrid_map.hpp"
#include "hmt/submap/map/map_file.hpp"

namespace hmt::apps {
namespace {

std::vector<submap::StampedPose> trajectory_of_map(const std::filesystem::path& path) {
  const submap::HybridMap map = submap::MapFile::open(path).load_map();
  const auto poses = submap::world_trajectory(map);
  std::vector<submap::StampedPose> trajectory;
  for (size_t i = 0; i < poses.size(); ++i)
    trajectory.push_back({map.track.observations[i].stamp_s, poses[i]});
  return trajectory;
}

}  // namespace

bool is_map_file(const std::filesystem::path& path) {
  constexpr std::string_view kMagic = "SQLite format 3";
  std::string head(kMagic.size(), '\0');
  std::ifstream(path, std::ios::binary)
      .read(head.data(), static_cast<std::streamsize>(head.size()));
  return head == kMagic;
}

std::vector<submap::StampedPose> load_trajectory(const std::filesystem::path& path) {
  return is_map_file(path) ? trajectory_of_map(path) : submap::read_tum(path);
}

}  // namespace hmt::apps
