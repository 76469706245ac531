// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_calibration.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace hmt::submap {
namespace {

// What a carpet, a load or a warm gyro changes in a hundred metres, or in a hundred seconds.
const Eigen::Vector4d kWander(0.003, 0.003, 0.01, 0.0005);
constexpr double kWanderLength_m = 100;
constexpr double kWanderTime_s = 100;
// A turn that is smaller than so many deviations may be noise: to learn from it would take the
// noise of a heading that drives straight on for turns of which nothing came.
constexpr double kTrueTurn = 4;
// 99.9 % of chi2 with two degrees of freedom: a wheel that slipped, which says nothing of the rest.
constexpr double kGate2 = 13.8;

/// Of the correction of x and yaw by the errors.
Eigen::Matrix<double, 2, 4> jacobian(const Pose& step, double duration_s) {
  const double driven_m = step.translation.x();
  Eigen::Matrix<double, 2, 4> J = Eigen::Matrix<double, 2, 4>::Zero();
  J(0, 0) = driven_m;
  J(1, 1) = driven_m;
  J(1, 2) = step.yaw_rad();
  J(1, 3) = duration_s;
  return J;
}

}  // namespace

OdometryErrors odometry_error_deviations() {
  return {0.05, 0.05, 0.05, 0.01};
}

Pose without_errors(const Pose& step, double duration_s, const OdometryErrors& errors) {
  const Eigen::Vector2d correction = jacobian(step, duration_s) * errors;
  // The turn happens all along the step: half of it before.
  const Pose half = Pose::planar(0, 0, correction[1] / 2);
  Pose scaled = step;
  scaled.translation.head<2>() *= 1 + errors[0];
  return half * scaled * half;
}

Eigen::Matrix<double, 6, 4> by_odometry_errors(const Pose& step, double duration_s,
                                               const OdometryErrors& errors) {
  const Pose corrected = without_errors(step, duration_s, errors);
  const Eigen::Matrix3d R_end_start = corrected.rotation_matrix().transpose();
  const Eigen::Vector3d& t = corrected.translation;
  Eigen::Matrix<double, 6, 4> J = Eigen::Matrix<double, 6, 4>::Zero();
  J.col(0).head<3>() = R_end_start * Eigen::Vector3d(t.x(), t.y(), 0) / (1 + errors[0]);
  const Eigen::Matrix<double, 1, 4> turn = jacobian(step, duration_s).row(1);
  J.topRows<3>() += R_end_start * Eigen::Vector3d(-t.y(), t.x(), 0) / 2 * turn;
  J.row(5) = turn;
  return J;
}

OdometryCalibration::OdometryCalibration()
    : covariance_(odometry_error_deviations().cwiseAbs2().asDiagonal()) {}

void OdometryCalibration::learn(const Pose& step, double duration_s, const Eigen::Vector2d& error,
                                const Eigen::Matrix2d& covariance) {
  const double share = std::min(1.0, step.translation.norm() / kWanderLength_m);
  Eigen::Vector4d wander = kWander.cwiseAbs2() * share;
  wander[3] = kWander[3] * kWander[3] * std::min(1.0, duration_s / kWanderTime_s);
  covariance_.diagonal() += wander;
  Eigen::Matrix<double, 2, 4> H = jacobian(step, duration_s);
  // The noise of the odometry's own turn is in `error` too, with the other sign.
  if (step.yaw_rad() * step.yaw_rad() < kTrueTurn * kTrueTurn * covariance(1, 1)) H(1, 2) = 0;
  const Eigen::Matrix2d innovation = H * covariance_ * H.transpose() + covariance;
  const Eigen::Matrix2d inverse = innovation.inverse();
  if (!inverse.allFinite() || error.dot(inverse * error) > kGate2) return;
  const Eigen::Matrix<double, 4, 2> gain = covariance_ * H.transpose() * inverse;
  state_ += gain * error;
  const Eigen::Matrix4d rest = Eigen::Matrix4d::Identity() - gain * H;
  covariance_ = rest * covariance_ * rest.transpose() + gain * covariance * gain.transpose();
}

}  // namespace hmt::submap
