// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pose.hpp"

#include <cmath>
#include <numbers>
#include <ostream>

namespace hmt::graph {

Pose Pose::planar(double x_m, double y_m, double yaw_rad) {
  return {{x_m, y_m, 0.0}, {std::cos(yaw_rad / 2), 0.0, 0.0, std::sin(yaw_rad / 2)}};
}

double Pose::yaw_rad() const {
  const Eigen::Quaterniond& q = rotation;
  return std::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z()));
}

Pose Pose::inverse() const {
  const Eigen::Quaterniond back = rotation.conjugate();
  return {-(back * translation), back};
}

Pose operator*(const Pose& T_a_b, const Pose& T_b_c) {
  return {T_a_b.translation + T_a_b.rotation * T_b_c.translation,
          (T_a_b.rotation * T_b_c.rotation).normalized()};
}

Eigen::Vector3d operator*(const Pose& T_a_b, const Eigen::Vector3d& p_b) {
  return T_a_b.translation + T_a_b.rotation * p_b;
}

bool operator==(const Pose& left, const Pose& right) {
  return left.translation == right.translation && left.rotation.coeffs() == right.rotation.coeffs();
}

std::ostream& operator<<(std::ostream& out, const Pose& T_a_b) {
  return out << "[" << T_a_b.translation.transpose() << " | " << T_a_b.rotation.coeffs().transpose()
             << "]";
}

Pose relative_pose(const Pose& T_w_a, const Pose& T_w_b) {
  return T_w_a.inverse() * T_w_b;
}

Pose boxplus(const Pose& T_a_b, const Vector6d& tangent_b) {
  const Eigen::Vector3d half = tangent_b.tail<3>() / 2;
  // Beyond the chart's edge (2 vec(q) has norm 2 at a rotation by pi) the nearest rotation is
  // taken.
  const double w = std::sqrt(std::max(0.0, 1 - half.squaredNorm()));
  return T_a_b * Pose{tangent_b.head<3>(),
                      Eigen::Quaterniond(w, half.x(), half.y(), half.z()).normalized()};
}

Vector6d boxminus(const Pose& T_to, const Pose& T_from) {
  const Pose step = relative_pose(T_from, T_to);
  const double sign = step.rotation.w() < 0 ? -1.0 : 1.0;
  Vector6d tangent;
  tangent << step.translation, 2 * sign * step.rotation.vec();
  return tangent;
}

Matrix6d adjoint(const Pose& T_a_b) {
  const Eigen::Matrix3d R = T_a_b.rotation_matrix();
  Matrix6d Ad = Matrix6d::Zero();
  Ad.topLeftCorner<3, 3>() = R;
  Ad.topRightCorner<3, 3>() = skew(T_a_b.translation) * R;
  Ad.bottomRightCorner<3, 3>() = R;
  return Ad;
}

Matrix6d compose_covariance(const Pose& T_b_c, const Matrix6d& covariance_a_b,
                            const Matrix6d& covariance_b_c) {
  const Matrix6d J = adjoint(T_b_c.inverse());
  return J * covariance_a_b * J.transpose() + covariance_b_c;
}

Matrix6d inverse_covariance(const Pose& T_a_b, const Matrix6d& covariance_a_b) {
  const Matrix6d Ad = adjoint(T_a_b);
  return Ad * covariance_a_b * Ad.transpose();
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

double wrap_angle(double angle_rad) {
  if (std::abs(angle_rad) < std::numbers::pi) return angle_rad;
  const double wrapped = std::remainder(angle_rad, 2 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? wrapped + 2 * std::numbers::pi : wrapped;
}

}  // namespace hmt::graph
