// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pose_factor.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>

namespace hmt::graph {
namespace {

template <class Chart>
constexpr std::array<int, Chart::kTangent> tangent_rows() {
  if constexpr (Chart::kTangent == 3)
    return {0, 1, 5};
  else
    return {0, 1, 2, 3, 4, 5};
}

/// W with W^T W = information. The Cholesky factor where there is one; a singular matrix goes by
/// its eigenvectors, where rounding below zero counts as zero.
template <class Matrix>
Matrix whitening_of(const Matrix& information) {
  const Eigen::LLT<Matrix> llt(information);
  if (llt.info() == Eigen::Success) return llt.matrixU();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(information);
  return eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

using ConstVector = Eigen::Map<const Eigen::Vector3d>;
using ConstQuaternion = Eigen::Map<const Eigen::Quaterniond>;

}  // namespace

PlanarChart::Measurement::Measurement(const Pose& T_from_to)
    : R_transposed(T_from_to.rotation_matrix().topLeftCorner<2, 2>().transpose()),
      translation(T_from_to.translation.head<2>()),
      yaw_rad(T_from_to.yaw_rad()) {}

void PlanarChart::store(const Pose& T_world_node, double* parameters) {
  parameters[0] = T_world_node.translation.x();
  parameters[1] = T_world_node.translation.y();
  parameters[2] = T_world_node.yaw_rad();
}

Pose PlanarChart::load(const double* parameters) {
  return Pose::planar(parameters[0], parameters[1], parameters[2]);
}

PlanarChart::Vector PlanarChart::error(const Measurement& measured, const double* from,
                                       const double* to) {
  const double c = std::cos(from[2]);
  const double s = std::sin(from[2]);
  const double dx = to[0] - from[0];
  const double dy = to[1] - from[1];
  Vector r;
  r << measured.R_transposed *
           (Eigen::Vector2d(c * dx + s * dy, c * dy - s * dx) - measured.translation),
      wrap_angle(to[2] - from[2] - measured.yaw_rad);
  return r;
}

PlanarChart::Vector PlanarChart::linearize(const Measurement& measured, const double* from,
                                           const double* to, Matrix& J_from, Matrix& J_to) {
  Eigen::Matrix2d R_from_T;
  R_from_T << std::cos(from[2]), std::sin(from[2]), -std::sin(from[2]), std::cos(from[2]);
  const Eigen::Vector2d local = R_from_T * Eigen::Vector2d(to[0] - from[0], to[1] - from[1]);
  J_to.setIdentity();
  J_to.topLeftCorner<2, 2>() = measured.R_transposed * R_from_T;
  J_from = -J_to;
  J_from.topRightCorner<2, 1>() = measured.R_transposed * Eigen::Vector2d(local.y(), -local.x());
  Vector r;
  r << measured.R_transposed * (local - measured.translation),
      wrap_angle(to[2] - from[2] - measured.yaw_rad);
  return r;
}

PlanarChart::PointVector PlanarChart::linearize_point(const double* node, const double* point,
                                                      PointByPose& J_node, PointMatrix& J_point) {
  J_point << std::cos(node[2]), std::sin(node[2]), -std::sin(node[2]), std::cos(node[2]);
  const PointVector local = J_point * PointVector(point[0] - node[0], point[1] - node[1]);
  J_node << -J_point, PointVector(local.y(), -local.x());
  return local;
}

SpatialChart::Measurement::Measurement(const Pose& T_from_to)
    : R_transposed(T_from_to.rotation_matrix().transpose()),
      translation(T_from_to.translation),
      q_inverse(T_from_to.rotation.conjugate()) {}

void SpatialChart::store(const Pose& T_world_node, double* parameters) {
  Eigen::Map<Eigen::Vector3d>{parameters} = T_world_node.translation;
  Eigen::Map<Eigen::Quaterniond>{parameters + 3} = T_world_node.rotation.normalized();
}

Pose SpatialChart::load(const double* parameters) {
  return {Eigen::Map<const Eigen::Vector3d>(parameters),
          Eigen::Map<const Eigen::Quaterniond>(parameters + 3)};
}

SpatialChart::Vector SpatialChart::error(const Measurement& measured, const double* from,
                                         const double* to) {
  const Eigen::Quaterniond q_from_T = ConstQuaternion(from + 3).conjugate();
  const Eigen::Vector3d local = q_from_T * (ConstVector(to) - ConstVector(from));
  const Eigen::Quaterniond q = measured.q_inverse * (q_from_T * ConstQuaternion(to + 3));
  Vector r;
  r << measured.R_transposed * (local - measured.translation), std::copysign(2.0, q.w()) * q.vec();
  return r;
}

// With the error quaternion (w, v), a turn a of `to` from the right makes 2 vec = 2 v + w a + v x
// a; a turn of `from` is its opposite from the left, carried through the measured rotation.
SpatialChart::Vector SpatialChart::linearize(const Measurement& measured, const double* from,
                                             const double* to, Matrix& J_from, Matrix& J_to) {
  const Eigen::Quaterniond q_from_T = ConstQuaternion(from + 3).conjugate();
  const Eigen::Matrix3d R_from_T = q_from_T.toRotationMatrix();
  const Eigen::Vector3d local = R_from_T * (ConstVector(to) - ConstVector(from));
  Eigen::Quaterniond q = measured.q_inverse * (q_from_T * ConstQuaternion(to + 3));
  if (std::signbit(q.w())) q.coeffs() = -q.coeffs();
  const Eigen::Matrix3d w = q.w() * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d v_cross = skew(q.vec());
  J_to.setZero();
  J_to.topLeftCorner<3, 3>() = measured.R_transposed * R_from_T;
  J_to.bottomRightCorner<3, 3>() = w + v_cross;
  J_from.setZero();
  J_from.topLeftCorner<3, 3>() = -J_to.topLeftCorner<3, 3>();
  J_from.topRightCorner<3, 3>() = measured.R_transposed * skew(local);
  J_from.bottomRightCorner<3, 3>() = (v_cross - w) * measured.R_transposed;
  Vector r;
  r << measured.R_transposed * (local - measured.translation), 2 * q.vec();
  return r;
}

SpatialChart::PointVector SpatialChart::linearize_point(const double* node, const double* point,
                                                        PointByPose& J_node, PointMatrix& J_point) {
  J_point = ConstQuaternion(node + 3).conjugate().toRotationMatrix();
  const PointVector local = J_point * (ConstVector(point) - ConstVector(node));
  J_node << -J_point, skew(local);
  return local;
}

template <class Chart>
Eigen::Matrix<double, Chart::kTangent, Chart::kTangent> chart_block(const Matrix6d& matrix) {
  constexpr auto rows = tangent_rows<Chart>();
  return matrix(rows, rows);
}

template <class Chart>
Matrix6d from_chart_block(const Eigen::Matrix<double, Chart::kTangent, Chart::kTangent>& block) {
  constexpr auto rows = tangent_rows<Chart>();
  Matrix6d matrix = Matrix6d::Zero();
  matrix(rows, rows) = block;
  return matrix;
}

template <class Chart>
typename Chart::Vector chart_vector(const Vector6d& vector) {
  constexpr auto rows = tangent_rows<Chart>();
  return vector(rows);
}

template <class Chart>
EdgeFactor<Chart>::EdgeFactor(const PoseGraphEdge& edge)
    : measured_(edge.T_from_to),
      whitening_(whitening_of<Matrix>(chart_block<Chart>(edge.information))) {}

template <class Chart>
PointFactor<Chart>::PointFactor(const PointEdge& edge)
    : measured_(edge.p_node.head<Chart::kPoint>()),
      whitening_(
          whitening_of<Matrix>(edge.information.topLeftCorner<Chart::kPoint, Chart::kPoint>())) {}

template class PointFactor<PlanarChart>;
template class PointFactor<SpatialChart>;
template class EdgeFactor<PlanarChart>;
template class EdgeFactor<SpatialChart>;
template Eigen::Matrix<double, 3, 3> chart_block<PlanarChart>(const Matrix6d&);
template Eigen::Matrix<double, 6, 6> chart_block<SpatialChart>(const Matrix6d&);
template PlanarChart::Vector chart_vector<PlanarChart>(const Vector6d&);
template SpatialChart::Vector chart_vector<SpatialChart>(const Vector6d&);
template Matrix6d from_chart_block<PlanarChart>(const Eigen::Matrix<double, 3, 3>&);
template Matrix6d from_chart_block<SpatialChart>(const Eigen::Matrix<double, 6, 6>&);

}  // namespace hmt::graph
