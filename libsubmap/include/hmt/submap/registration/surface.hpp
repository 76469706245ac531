// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// The surfaces that an observation saw: its points with their normals and noise, in the robot
/// frame. All vectors have one entry a point.
struct Surface {
  std::vector<Eigen::Vector3d> points_robot;
  /// Unit normal towards the sensor; zero where the neighbors do not define one (corners, lone
  /// points).
  std::vector<Eigen::Vector3d> normals_robot;
  /// Standard deviation of the point along its normal, metres.
  std::vector<double> sigma_m;

  size_t size() const { return points_robot.size(); }
};

/// Points and normals of all readings of an observation. Points beyond the sensor's maximum are not
/// there; an observation without points gives an empty surface.
Surface make_surface(const Observation& observation);

}  // namespace hmt::submap
