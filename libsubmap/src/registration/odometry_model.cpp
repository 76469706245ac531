// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_model.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

// Turning by a radian moves the wheels of a robot about as much as driving this far.
constexpr double kTurnLength_m = 0.3;
// What even a robot at rest may shift between two observations.
constexpr double kRestTranslation_m = 0.001;
constexpr double kRestRotation_rad = 0.0005;
// Observations of a sensor of some tens of metres this far apart do not overlap enough to be
// registered, so a larger step cannot be confirmed.
constexpr double kLargestStep_m = 10;
// Motion after which what was learnt counts half: a carpet or a heap of people changes the slip.
constexpr double kMemory = 50;

struct Motion {
  double translation = 0;  // distance + l |rotation|
  double rotation = 0;     // |rotation| + distance / l
};

Motion motion_of(const Pose& step) {
  const double distance_m = step.translation.norm();
  const double angle_rad = 2 * std::atan2(step.rotation.vec().norm(), std::abs(step.rotation.w()));
  return {distance_m + kTurnLength_m * angle_rad, angle_rad + distance_m / kTurnLength_m / 10};
}

}  // namespace

Matrix6d OdometryModel::covariance(const Pose& step) const {
  const Motion motion = motion_of(step);
  const double translation =
      translation_.value() * motion.translation + kRestTranslation_m * kRestTranslation_m;
  const double rotation =
      rotation_.value() * motion.rotation + kRestRotation_rad * kRestRotation_rad;
  Vector6d variances;
  variances << translation, translation, translation, rotation, rotation, rotation;
  if (space_ == Space::se2) variances.segment<3>(2).setZero();
  return variances.asDiagonal();
}

void OdometryModel::learn(const Pose& odometry_step, const Pose& measured_step) {
  const Motion motion = motion_of(odometry_step);
  const Vector6d error = boxminus(measured_step, odometry_step);
  const double axes = space_ == Space::se2 ? 2 : 3;
  const double turns = space_ == Space::se2 ? 1 : 3;
  const auto add = [](Rate& rate, double square, double amount) {
    const double keep = std::exp2(-amount / kMemory);
    rate.squares = keep * rate.squares + square;
    rate.motion = keep * rate.motion + amount;
  };
  add(translation_, error.head<3>().squaredNorm() / axes, motion.translation);
  add(rotation_, error.tail<3>().squaredNorm() / turns, motion.rotation);
}

bool OdometryModel::is_motion(const Pose& step) {
  return step.translation.allFinite() && step.rotation.coeffs().allFinite() &&
         step.translation.norm() <= kLargestStep_m;
}

}  // namespace hmt::submap
