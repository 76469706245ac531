// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "hmt/submap/link/loop_search.hpp"
#include "hmt/submap/registration/surface.hpp"

namespace hmt::submap {

/// How far a sensor saw in each direction of the plane.
struct SightFan {
  Pose T_robot_sensor;
  double step_rad = 0;  ///< width of a bin
  std::vector<float>
      range_m;  ///< shortest range of each bin, from -pi on; 0 where nothing is known
};

/// What the loop search keeps of a keyframe's observation: its points in the plane, thinned, and
/// its sight. Some kilobytes each, so that all keyframes fit into memory at once.
struct PlanarScan {
  std::vector<Eigen::Vector2f> points_robot;
  std::vector<SightFan> sight;
};

/// Beams that returned nothing are left out: glass and dark surfaces return nothing as well.
PlanarScan make_planar_scan(const Observation& observation);

/// Of clouds: the points on upright surfaces, seen from above. What stands upright looks the same
/// from any height, and ground and ceiling say nothing about the place. A cloud looks over and
/// under what is in its way, so it tells of no free space in the plane. `T_level_robot`: tilt and
/// height.
PlanarScan make_upright_scan(const Surface& surface, const Pose& T_level_robot);

/// True where the observation looked through the place of a point: a surface was seen at least
/// `margin_m` behind it in its direction and in both neighboring ones.
bool sees_through(const PlanarScan& scan, const Eigen::Vector2d& p_robot, double margin_m);

/// One point for each square of `cell_m`, the first that falls into it.
std::vector<Eigen::Vector2f> thin_points(std::span<const Eigen::Vector2f> points, double cell_m);

}  // namespace hmt::submap
