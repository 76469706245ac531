// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_calibration.hpp"

#include <Eigen/LU>
#include <algorithm>

namespace hmt::submap {
namespace {

// Before anything is learnt: five percent of length and turn, 3 deg per metre, half a degree per
// second.
const Eigen::Vector4d kSigma0(0.05, 0.05, 0.05, 0.01);
// What a carpet, a load or a warm gyro changes in a hundred metres, or in a hundred seconds.
const Eigen::Vector4d kWander(0.003, 0.003, 0.01, 0.0005);
constexpr double kWanderLength_m = 100;
constexpr double kWanderTime_s = 100;
// 99.9 % of chi2 with two degrees of freedom: a wheel that slipped, which says nothing of the rest.
constexpr double kGate2 = 13.8;

}  // namespace

OdometryCalibration::OdometryCalibration() : covariance_(kSigma0.cwiseAbs2().asDiagonal()) {}

Eigen::Matrix<double, 2, 4> OdometryCalibration::jacobian(const Pose& step, double duration_s) {
  const double driven_m = step.translation.x();
  Eigen::Matrix<double, 2, 4> J = Eigen::Matrix<double, 2, 4>::Zero();
  J(0, 0) = driven_m;
  J(1, 1) = driven_m;
  J(1, 2) = step.yaw_rad();
  J(1, 3) = duration_s;
  return J;
}

Pose OdometryCalibration::corrected(const Pose& step, double duration_s) const {
  const Eigen::Vector2d correction = jacobian(step, duration_s) * state_;
  // The turn happens all along the step: half of it before.
  const Pose half = Pose::planar(0, 0, correction[1] / 2);
  Pose scaled = step;
  scaled.translation.head<2>() *= 1 + state_[0];
  return half * scaled * half;
}

void OdometryCalibration::learn(const Pose& step, double duration_s, const Eigen::Vector2d& error,
                                const Eigen::Matrix2d& covariance) {
  const double share = std::min(1.0, step.translation.norm() / kWanderLength_m);
  Eigen::Vector4d wander = kWander.cwiseAbs2() * share;
  wander[3] = kWander[3] * kWander[3] * std::min(1.0, duration_s / kWanderTime_s);
  covariance_.diagonal() += wander;
  const Eigen::Matrix<double, 2, 4> H = jacobian(step, duration_s);
  const Eigen::Matrix2d innovation = H * covariance_ * H.transpose() + covariance;
  const Eigen::Matrix2d inverse = innovation.inverse();
  if (!inverse.allFinite() || error.dot(inverse * error) > kGate2) return;
  const Eigen::Matrix<double, 4, 2> gain = covariance_ * H.transpose() * inverse;
  state_ += gain * error;
  const Eigen::Matrix4d rest = Eigen::Matrix4d::Identity() - gain * H;
  covariance_ = rest * covariance_ * rest.transpose() + gain * covariance * gain.transpose();
}

}  // namespace hmt::submap
