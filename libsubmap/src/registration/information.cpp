// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "information.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>

namespace hmt::submap {
namespace {

constexpr std::array<int, 3> kPlane{0, 1, 5};

// Information so small (100 m, 100 rad) that it says nothing, which makes singular sums invertible.
constexpr double kNothing = 1e-4;

}  // namespace

Matrix6d inverse_in(Space space, const Matrix6d& matrix) {
  if (space == Space::se3) return matrix.inverse();
  Matrix6d inverse = Matrix6d::Zero();
  const Eigen::Matrix3d planar = matrix(kPlane, kPlane);
  inverse(kPlane, kPlane) = planar.inverse();
  return inverse;
}

Matrix6d compose_information(Space space, const Pose& T_b_c, const Matrix6d& information_a_b,
                             const Matrix6d& information_b_c) {
  const Matrix6d Ad = adjoint(T_b_c);
  const Matrix6d first = Ad.transpose() * information_a_b * Ad;
  // Parallel sum A (A + B)^-1 B, which is (A^-1 + B^-1)^-1 where these exist.
  const Matrix6d sum = first + information_b_c + kNothing * Matrix6d::Identity();
  const Matrix6d result = first * inverse_in(space, sum) * information_b_c;
  return (result + result.transpose()) / 2;
}

bool observes_all(Space space, const Matrix6d& information, const Matrix6d& predicted) {
  const Eigen::ArrayXi used =
      space == Space::se2 ? Eigen::ArrayXi{{0, 1, 5}} : Eigen::ArrayXi{{0, 1, 2, 3, 4, 5}};
  const Eigen::MatrixXd measured = information(used, used);
  const Eigen::MatrixXd prior = predicted(used, used);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(measured, prior);
  return eigen.eigenvalues()[0] > 1;
}

}  // namespace hmt::submap
