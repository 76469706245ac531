// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/constraint.hpp"

#include <Eigen/Eigenvalues>

namespace hmt::submap {

double firmness(const Constraint& constraint, Space space) {
  const Matrix6d& information = constraint.information;
  if (space == Space::se3)
    return Eigen::SelfAdjointEigenSolver<Matrix6d>(information, Eigen::EigenvaluesOnly)
        .eigenvalues()[0];
  const Eigen::Array3i plane(0, 1, 5);
  const Eigen::Matrix3d in_plane = information(plane, plane);
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(in_plane, Eigen::EigenvaluesOnly)
      .eigenvalues()[0];
}

}  // namespace hmt::submap
