// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/sighting.hpp"

namespace hmt::submap {

/// A local metric map: its frame and the poses of its keyframes in it. It holds no world pose: that
/// lives in the graph.
struct Submap {
  int id = 0;
  std::vector<int> keyframes;  ///< increasing; the first one is the frame: its pose is the identity
  std::vector<Pose> T_submap_keyframe;  ///< one a keyframe
  std::vector<Matrix6d> covariances;    ///< of each pose (tangent of Pose, frame keyframe)
  std::vector<int> constraints;  ///< indices into the constraints of the map with both ends inside
  std::vector<PlacedLandmark> landmarks;  ///< that its keyframes saw, in its frame, by number
  double chi2 = 0;                        ///< of the local optimization
  int degrees_of_freedom = 0;

  bool operator==(const Submap&) const = default;
};

}  // namespace hmt::submap
