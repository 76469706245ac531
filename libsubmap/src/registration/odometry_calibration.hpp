// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// What the odometry of a log does wrong always, as what must be added to it: a length by a share,
/// a turn per metre driven (radians), a turn by a share of itself, and a turn per second (radians)
/// of a gyro that drifts.
using OdometryErrors = Eigen::Vector4d;

/// Their deviations before anything is learnt: five percent of length and turn, 3 deg per metre,
/// half a degree per second.
OdometryErrors odometry_error_deviations();

/// A step in the plane without these errors. `duration_s`: time that it took.
Pose without_errors(const Pose& step, double duration_s, const OdometryErrors& errors);

/// Derivative of without_errors() by the errors: rows by the tangent of Pose, frame of its end.
Eigen::Matrix<double, 6, 4> by_odometry_errors(const Pose& step, double duration_s,
                                               const OdometryErrors& errors);

/// Learns the errors of odometry from the registrations by a Kalman filter whose state they are, so
/// that in a place that fixes nothing along it, such as a corridor, they do not add up.
class OdometryCalibration {
 public:
  OdometryCalibration();

  /// The step without what is known to be wrong.
  Pose corrected(const Pose& step, double duration_s) const {
    return without_errors(step, duration_s, state_);
  }

  /// Learns from a step whose correction was off by `error` (tangent of Pose in the plane, x and
  /// yaw are used), known to `covariance` (of x and yaw).
  void learn(const Pose& step, double duration_s, const Eigen::Vector2d& error,
             const Eigen::Matrix2d& covariance);

 private:
  OdometryErrors state_ = OdometryErrors::Zero();
  Eigen::Matrix4d covariance_;
};

}  // namespace hmt::submap
