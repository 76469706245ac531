// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/map/hybrid_map.hpp"

#include <algorithm>

namespace hmt::submap {

Pose world_pose(const HybridMap& map, int keyframe) {
  const auto id = static_cast<size_t>(map.submap_of_keyframe.at(static_cast<size_t>(keyframe)));
  const Submap& submap = map.submaps.at(id);
  const auto at = std::lower_bound(submap.keyframes.begin(), submap.keyframes.end(), keyframe);
  return map.T_world_submap.at(id) *
         submap.T_submap_keyframe.at(static_cast<size_t>(at - submap.keyframes.begin()));
}

std::vector<Pose> world_trajectory(const HybridMap& map) {
  std::vector<Pose> T_world_keyframe;
  for (const Keyframe& keyframe : map.track.keyframes)
    T_world_keyframe.push_back(world_pose(map, keyframe.id));
  std::vector<Pose> T_world_robot;
  T_world_robot.reserve(map.track.observations.size());
  for (const TrackedObservation& tracked : map.track.observations)
    T_world_robot.push_back(T_world_keyframe.at(static_cast<size_t>(tracked.keyframe)) *
                            tracked.T_keyframe_robot);
  return T_world_robot;
}

}  // namespace hmt::submap
