// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/map/placed_observation.hpp"

#include <algorithm>

namespace hmt::submap {

std::vector<PlacedObservation> observations_in_submap(const Track& track, const Submap& submap) {
  std::vector<PlacedObservation> placed;
  for (const TrackedObservation& tracked : track.observations) {
    const auto at =
        std::lower_bound(submap.keyframes.begin(), submap.keyframes.end(), tracked.keyframe);
    if (at == submap.keyframes.end() || *at != tracked.keyframe) continue;
    const auto k = static_cast<size_t>(at - submap.keyframes.begin());
    placed.push_back(
        {tracked.observation, submap.T_submap_keyframe.at(k) * tracked.T_keyframe_robot});
  }
  return placed;
}

std::vector<PlacedObservation> observations_in_world(const HybridMap& map) {
  const std::vector<Pose> T_world_robot = world_trajectory(map);
  std::vector<PlacedObservation> placed;
  for (size_t k = 0; k < T_world_robot.size(); ++k)
    placed.push_back({map.track.observations[k].observation, T_world_robot[k]});
  return placed;
}

}  // namespace hmt::submap
