// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/submap/map/hybrid_map.hpp"

namespace hmt::submap {

/// An observation of the map file and where the robot stood in the frame that is drawn in.
struct PlacedObservation {
  int64_t observation = 0;
  Pose T_frame_robot;

  bool operator==(const PlacedObservation&) const = default;
};

/// All observations that hang on the keyframes of a submap, in its frame, in the order of the log.
std::vector<PlacedObservation> observations_in_submap(const Track& track, const Submap& submap);
/// All observations in the world frame, in the order of the log.
std::vector<PlacedObservation> observations_in_world(const HybridMap& map);

}  // namespace hmt::submap
