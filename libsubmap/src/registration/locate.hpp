// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/registration/register_surface.hpp"
#include "local_map.hpp"

namespace hmt::submap {

/// Where a robot is expected on its local map, before its surfaces are looked at.
struct Prediction {
  Pose T_map_robot;
  Pose T_map_latest;                        ///< at the latest observation
  Matrix6d covariance = Matrix6d::Zero();   ///< frame robot
  Matrix6d information = Matrix6d::Zero();  ///< its inverse
  double step_m = 0;                        ///< driven since the latest observation
};

struct LocatedSurface {
  Registration registration;
  /// Whether enough of the surface meets the map, and nothing speaks against what it says of the
  /// prediction.
  bool fits = false;
  bool searched = false;  ///< whether the registration from the prediction was in doubt
};

/// Registers a surface on the local map from a prediction. Where that explains too little of it,
/// contradicts the prediction, or would have looked through what stands in the map, other poses are
/// searched. In the plane within the prediction's covariance, then within what the worst of wheels
/// leave open, there only for an unambiguous one; in space by a registration from farther away.
/// `blind`: the prediction is a guess, so a search is made in any case, in space also around the
/// guess and the latest pose, unless the cloud meets the map clearly.
LocatedSurface locate(Space space, const Surface& surface, const LocalMap& map,
                      const Prediction& prediction, bool blind);

}  // namespace hmt::submap
