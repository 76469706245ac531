// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <iosfwd>

namespace hmt::graph {

/// 6x6 matrix over the tangent of a pose, in the order (x, y, z, rx, ry, rz): metres first, then
/// radians.
using Matrix6d = Eigen::Matrix<double, 6, 6>;
/// Tangent vector of a pose: (x, y, z, rx, ry, rz).
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Which poses a problem admits: the plane z = 0 with a heading, or all of space.
enum class Space { se2, se3 };

/// Rigid transformation T_a_b: p_a = T_a_b * p_b. One type for the plane and for space; a planar
/// pose has z = 0 and a rotation about z alone.
///
/// Perturbations act on the right, in frame b: T boxplus d = T * (d.xyz, q(d.rotation)), with the
/// chart rotation = 2 vec(q), which equals the rotation vector to first order. A covariance of
/// T_a_b is that of d, so it is expressed in frame b.
struct Pose {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();

  /// Planar pose: x and y in metres, heading in radians.
  static Pose planar(double x_m, double y_m, double yaw_rad);

  /// Heading in (-pi, pi]: the angle of the rotated x axis in the xy plane.
  double yaw_rad() const;

  Pose inverse() const;
  Eigen::Matrix3d rotation_matrix() const { return rotation.toRotationMatrix(); }
};

/// T_a_c = T_a_b * T_b_c; the rotation stays normalized.
Pose operator*(const Pose& T_a_b, const Pose& T_b_c);
/// p_a = T_a_b * p_b.
Eigen::Vector3d operator*(const Pose& T_a_b, const Eigen::Vector3d& p_b);
/// Exact equality, number by number.
bool operator==(const Pose& left, const Pose& right);
std::ostream& operator<<(std::ostream& out, const Pose& T_a_b);

/// T_a_b = T_w_a^-1 * T_w_b.
Pose relative_pose(const Pose& T_w_a, const Pose& T_w_b);

/// T boxplus tangent, see Pose.
Pose boxplus(const Pose& T_a_b, const Vector6d& tangent_b);
/// The tangent d for which boxplus(T_from, d) == T_to; rotations by less than pi.
Vector6d boxminus(const Pose& T_to, const Pose& T_from);

/// Adjoint of T_a_b in tangent order (translation, rotation): d_a = Ad * d_b carries a small
/// perturbation from the right of T_a_b to its left, T_a_b boxplus d_b == (d_a) T_a_b to first
/// order.
Matrix6d adjoint(const Pose& T_a_b);

/// Covariance of T_a_c = T_a_b * T_b_c to first order, from independent factors (each in its own
/// right frame).
Matrix6d compose_covariance(const Pose& T_b_c, const Matrix6d& covariance_a_b,
                            const Matrix6d& covariance_b_c);
/// Covariance of T_b_a = T_a_b^-1 to first order.
Matrix6d inverse_covariance(const Pose& T_a_b, const Matrix6d& covariance_a_b);

/// The matrix of the cross product: skew(v) * w = v x w.
Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// Angle in (-pi, pi] that equals `angle_rad` modulo 2 pi.
double wrap_angle(double angle_rad);

}  // namespace hmt::graph
