// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// What the odometry of a log does wrong always: a length that is too long or too short by a share,
/// a turn per metre driven, a turn by a share of itself, and a turn per second of a gyro that
/// drifts. Learnt from the registrations by a Kalman filter whose state is these four numbers, so
/// that in a place that fixes nothing along it, such as a corridor, they do not add up.
class OdometryCalibration {
 public:
  OdometryCalibration();

  /// The step without what is known to be wrong. `duration_s`: time that it took.
  Pose corrected(const Pose& step, double duration_s) const;

  /// Learns from a step whose correction was off by `error` (tangent of Pose in the plane, x and
  /// yaw are used), known to `covariance` (of x and yaw).
  void learn(const Pose& step, double duration_s, const Eigen::Vector2d& error,
             const Eigen::Matrix2d& covariance);

 private:
  using State = Eigen::Vector4d;  // length, turn per metre, turn per turn, turn per second
  static Eigen::Matrix<double, 2, 4> jacobian(const Pose& step, double duration_s);

  State state_ = State::Zero();
  Eigen::Matrix4d covariance_;
};

}  // namespace hmt::submap
