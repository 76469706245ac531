// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pose_factor.hpp"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "pose_graph_builder.hpp"

namespace hmt::graph {
namespace {

/// The error as the header of PoseOptimizer defines it, for any scalar: steps on `from` and `to`
/// as the charts define them.
template <class T>
Eigen::Matrix<T, 6, 1> defined_error(const PoseGraphEdge& edge, const Pose& from, const Pose& to,
                                     const Eigen::Matrix<T, 12, 1>& steps) {
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Quaternion = Eigen::Quaternion<T>;
  const auto turn = [](const Pose& pose, const Vector& step) -> Quaternion {
    const Vector half = step / T(2);
    return pose.rotation.cast<T>() *
           Quaternion(sqrt(T(1) - half.squaredNorm()), half.x(), half.y(), half.z());
  };
  const Vector t_from = from.translation.cast<T>() + steps.template segment<3>(0);
  const Vector t_to = to.translation.cast<T>() + steps.template segment<3>(6);
  const Quaternion q_from = turn(from, steps.template segment<3>(3));
  const Quaternion q_to = turn(to, steps.template segment<3>(9));
  const Quaternion q_z = edge.T_from_to.rotation.cast<T>();
  Quaternion q = q_z.conjugate() * q_from.conjugate() * q_to;
  if (q.w() < T(0)) q.coeffs() = -q.coeffs();
  Eigen::Matrix<T, 6, 1> r;
  r << q_z.conjugate() *
           (q_from.conjugate() * (t_to - t_from) - edge.T_from_to.translation.cast<T>()),
      T(2) * q.vec();
  return r;
}

using Jet = ceres::Jet<double, 12>;

Eigen::Matrix<Jet, 12, 1> steps_of_jets() {
  Eigen::Matrix<Jet, 12, 1> steps;
  for (int k = 0; k < 12; ++k) steps[k] = Jet(0.0, k);
  return steps;
}

TEST(EdgeFactor, SpatialDerivativesEqualThoseOfAutomaticDifferentiation) {
  std::mt19937 generator(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Pose from = test::random_pose(generator, {1, 2, 3}, 0.4);
    const Pose to = test::random_pose(generator, {-1, 0, 2}, 0.4);
    const PoseGraphEdge edge{0, 1, test::random_pose(generator, {0, 1, 0}, 0.4),
                             test::random_information(generator)};
    const auto expected = defined_error<Jet>(edge, from, to, steps_of_jets());
    const Matrix6d W = edge.information.llt().matrixU();
    Eigen::Matrix<double, 6, 12> J;
    Vector6d r;
    for (int row = 0; row < 6; ++row) {
      r[row] = expected[row].a;
      J.row(row) = expected[row].v.transpose();
    }
    double p_from[7], p_to[7];
    SpatialChart::store(from, p_from);
    SpatialChart::store(to, p_to);
    const EdgeFactor<SpatialChart> factor(edge);
    SpatialChart::Matrix J_from, J_to;
    EXPECT_LT((factor.linearize(p_from, p_to, J_from, J_to) - W * r).norm(), 1e-12);
    EXPECT_LT((factor.error(p_from, p_to) - W * r).norm(), 1e-12);
    EXPECT_LT((J_from - W * J.leftCols<6>()).norm(), 1e-11);
    EXPECT_LT((J_to - W * J.rightCols<6>()).norm(), 1e-11);
  }
}

/// The planar error r = (R_z^T (R_from^T (t_to - t_from) - t_z), yaw_to - yaw_from - yaw_z).
template <class T>
Eigen::Matrix<T, 3, 1> defined_planar_error(const Pose& z, const T* from, const T* to) {
  const Eigen::Rotation2D<T> R_from(from[2]), R_z(T(z.yaw_rad()));
  const Eigen::Matrix<T, 2, 1> step(to[0] - from[0], to[1] - from[1]);
  Eigen::Matrix<T, 3, 1> r;
  r << R_z.inverse() * (R_from.inverse() * step - z.translation.head<2>().cast<T>()),
      to[2] - from[2] - T(z.yaw_rad());
  return r;
}

TEST(EdgeFactor, PlanarDerivativesEqualThoseOfAutomaticDifferentiation) {
  using PlanarJet = ceres::Jet<double, 6>;
  std::mt19937 generator(8);
  std::uniform_real_distribution<double> uniform(-0.7, 0.7);
  for (int trial = 0; trial < 50; ++trial) {
    double p[6];
    PlanarJet jets[6];
    for (int k = 0; k < 6; ++k) jets[k] = PlanarJet(p[k] = uniform(generator), k);
    const Pose z = Pose::planar(uniform(generator), uniform(generator), uniform(generator));
    const PoseGraphEdge edge{0, 1, z, test::random_information(generator)};
    const auto expected = defined_planar_error<PlanarJet>(z, jets, jets + 3);
    const Eigen::Matrix3d W = chart_block<PlanarChart>(edge.information).llt().matrixU();
    Eigen::Matrix<double, 3, 6> J;
    Eigen::Vector3d r;
    for (int row = 0; row < 3; ++row) {
      r[row] = expected[row].a;
      J.row(row) = expected[row].v.transpose();
    }
    const EdgeFactor<PlanarChart> factor(edge);
    PlanarChart::Matrix J_from, J_to;
    EXPECT_LT((factor.linearize(p, p + 3, J_from, J_to) - W * r).norm(), 1e-12);
    EXPECT_LT((factor.error(p, p + 3) - W * r).norm(), 1e-12);
    EXPECT_LT((J_from - W * J.leftCols<3>()).norm(), 1e-11);
    EXPECT_LT((J_to - W * J.rightCols<3>()).norm(), 1e-11);
  }
}

TEST(EdgeFactor, ErrorIsBoxminusAndIgnoresTheSignOfAQuaternion) {
  std::mt19937 generator(9);
  const Pose from = test::random_pose(generator, {1, 2, 3}, 0.5);
  Pose to = test::random_pose(generator, {0, 2, 3}, 0.5);
  const PoseGraphEdge edge = test::edge(0, 1, test::random_pose(generator, {0, 0, 0}, 0.5));
  const Vector6d expected = boxminus(relative_pose(from, to), edge.T_from_to);
  for (int sign = 0; sign < 2; ++sign) {
    double p_from[7], p_to[7];
    SpatialChart::store(from, p_from);
    SpatialChart::store(to, p_to);
    EXPECT_LT((EdgeFactor<SpatialChart>(edge).error(p_from, p_to) - expected).norm(), 1e-12);
    to.rotation.coeffs() *= -1;
  }
}

}  // namespace
}  // namespace hmt::graph
