// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "hmt/submap/map/hybrid_map.hpp"

namespace hmt::submap {

/// Where the robot stood at two keyframes this close to each other, and a constraint ties them, it
/// gets from one to the other although it never drove so.
inline constexpr double kPassable_m = 1;

/// A position in the world, metres; any height where there is none.
struct Place {
  double x_m = 0;
  double y_m = 0;
  std::optional<double> z_m;
};

/// A keyframe on a route.
struct RouteStep {
  int keyframe = 0;
  int submap = 0;
  Pose T_world_keyframe;
  double length_m = 0;  ///< of the route up to here
  /// Of the pose seen from the first step, by all constraints of the map; tangent of Pose, frame of
  /// this keyframe.
  Matrix6d covariance = Matrix6d::Zero();
};

/// A way through a map along poses that the robot was at.
struct Route {
  std::vector<RouteStep> steps;  ///< at least one
  double start_distance_m = 0;   ///< from the place asked for to the first step
  double goal_distance_m = 0;    ///< from the last step to the place asked for

  double length_m() const { return steps.back().length_m; }
};

/// The shortest way from the keyframe nearest to `start` to the one nearest to `goal`: along the
/// robot's path, and across where two of its visits pass within kPassable_m. Of equally near
/// keyframes the first. Throws InputError for a place that is not finite, and where the map does
/// not tell how well the goal is known from the start.
Route find_route(const HybridMap& map, const Place& start, const Place& goal, int threads);

}  // namespace hmt::submap
