// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// Arc between two submaps, a < b.
struct Link {
  int a = 0;
  int b = 0;
  Pose T_a_b;  ///< pose of the frame of b in the frame of a, condensed from the evidence
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_a_b, tangent of Pose (frame b)
  std::vector<int> evidence;    ///< indices into the constraints of the map across the cut
  std::vector<int> landmarks;   ///< numbers of those that both submaps saw
  double ncut = 0;              ///< Eq. 1 between the two submaps
  double information_loss = 0;  ///< share of the map's information across this cut, Eq. 22

  bool operator==(const Link&) const = default;
};

}  // namespace hmt::submap
