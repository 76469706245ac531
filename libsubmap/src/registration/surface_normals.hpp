// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hmt::submap {

/// What the neighbors of a point tell about the surface there; sensor frame.
struct PointNormal {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< towards the sensor; zero: not defined
  double sigma_m = 0;
  double normal_sigma_rad = 0;
  double spacing_m = 0;
};

/// Points of a planar scan (z = 0) in beam order.
std::vector<PointNormal> scan_normals(const std::vector<Eigen::Vector3d>& points_sensor,
                                      double beam_step_rad);

/// Points of a cloud in any order: the normals of the first and of every so-many-th after it, from
/// all points around them.
std::vector<PointNormal> cloud_normals(const std::vector<Eigen::Vector3d>& points_sensor,
                                       double beam_step_rad, size_t every);

}  // namespace hmt::submap
