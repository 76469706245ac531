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
  /// points, mixed pixels at range jumps).
  std::vector<Eigen::Vector3d> normals_robot;
  /// Standard deviation of the point along its normal, metres.
  std::vector<double> sigma_m;
  /// Standard deviation of the direction of the normal, radians; 0 without a normal.
  std::vector<double> normal_sigma_rad;
  /// Distance between neighboring points on the surface at this point, metres.
  std::vector<double> spacing_m;

  size_t size() const { return points_robot.size(); }

  bool operator==(const Surface&) const = default;
};

/// Points and normals of all readings of an observation, of a cloud of more than 10000 points those
/// of every so-many-th, at most as many. Points beyond the sensor's maximum are not
/// there; an observation without points gives an empty surface.
///
/// A planar scan takes the neighbors of a point along the beams, a cloud takes them within a
/// radius; both radii grow with the distance between beams at that range. The noise comes from the
/// residuals of these local fits: no sensor model is assumed.
Surface make_surface(const Observation& observation);

}  // namespace hmt::submap
