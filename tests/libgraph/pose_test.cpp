// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pose.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace hmt::graph {
namespace {

Pose sample_pose(double k) {
  return {{k, 2 * k - 1, 0.5 - k},
          Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * k, Eigen::Vector3d(1, k, -2).normalized()))};
}

TEST(Pose, QuarterTurnMovesXAxisToYAxis) {
  const Pose T = Pose::planar(1, 2, std::numbers::pi / 2);
  EXPECT_TRUE((T * Eigen::Vector3d(3, 0, 0)).isApprox(Eigen::Vector3d(1, 5, 0)));
  EXPECT_NEAR(T.yaw_rad(), std::numbers::pi / 2, 1e-15);
}

TEST(Pose, InverseComposesToIdentity) {
  const Pose T = sample_pose(1.7);
  EXPECT_LT(boxminus(T * T.inverse(), Pose{}).norm(), 1e-14);
}

TEST(Pose, BoxminusUndoesBoxplus) {
  Vector6d tangent;
  tangent << 0.1, -0.2, 0.3, 0.4, -0.5, 0.6;
  const Pose T = sample_pose(0.8);
  EXPECT_LT((boxminus(boxplus(T, tangent), T) - tangent).norm(), 1e-13);
}

TEST(Pose, AdjointCarriesPerturbationToTheLeft) {
  Vector6d small;
  small << 1, -2, 3, -1, 2, 0.5;
  small *= 1e-7;
  const Pose T = sample_pose(1.1);
  const Pose right = boxplus(T, small);
  const Pose left = boxplus(Pose{}, adjoint(T) * small) * T;
  EXPECT_LT(boxminus(left, right).norm(), 1e-12);
}

TEST(Pose, ComposedCovarianceMatchesNumericalJacobian) {
  const Pose T_a_b = sample_pose(0.4);
  const Pose T_b_c = sample_pose(-1.3);
  const double h = 1e-6;
  Matrix6d J;
  for (int k = 0; k < 6; ++k)
    J.col(k) = boxminus(boxplus(T_a_b, h * Vector6d::Unit(k)) * T_b_c, T_a_b * T_b_c) / h;
  const Matrix6d covariance = (Vector6d() << 1, 2, 3, 4, 5, 6).finished().asDiagonal();
  const Matrix6d expected = J * covariance * J.transpose();
  EXPECT_TRUE(compose_covariance(T_b_c, covariance, Matrix6d::Zero()).isApprox(expected, 1e-5));
}

TEST(Skew, IsTheCrossProduct) {
  const Eigen::Vector3d v(1, -2, 3), w(0.5, 4, -1);
  EXPECT_TRUE((skew(v) * w).isApprox(v.cross(w)));
}

TEST(WrapAngle, MapsPlusAndMinusPiToPi) {
  EXPECT_DOUBLE_EQ(wrap_angle(-std::numbers::pi), std::numbers::pi);
  EXPECT_DOUBLE_EQ(wrap_angle(3 * std::numbers::pi), std::numbers::pi);
  EXPECT_NEAR(wrap_angle(2 * std::numbers::pi + 0.1), 0.1, 1e-12);
}

}  // namespace
}  // namespace hmt::graph
