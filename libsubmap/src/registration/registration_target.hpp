// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/submap/registration/register_surface.hpp"
#include "point_grid.hpp"

namespace hmt::submap {

/// A piece of surface: the merged points of a small cell that agree in their normals.
struct SurfaceElement {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double variance = 0;         ///< of the point along the normal, m^2
  double normal_variance = 0;  ///< of the direction, rad^2
  double spacing_m = 0;        ///< distance to the neighbors on the surface
  int surfaces = 0;            ///< that it was seen in
};

struct RegistrationTarget::Impl {
  std::vector<SurfaceElement> elements;
  PointGrid grid;
  bool planar = true;  ///< all elements lie in z = 0
};

}  // namespace hmt::submap
