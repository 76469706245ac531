// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_model.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

// Turning by a radian moves the wheels of a robot about as much as driving this far.
constexpr double kTurnLength_m = 0.3;
// Odometry that moves less is at rest.
constexpr double kRest = 1e-3;
// Observations of a sensor of some tens of metres this far apart do not overlap enough to be
// registered, so a larger step cannot be confirmed.
constexpr double kLargestStep_m = 10;
// Motion after which what was learnt counts half: a carpet or a heap of people changes the slip.
constexpr double kMemory = 50;
constexpr double kRestMemory = 200;  // steps

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

void OdometryModel::Rate::add(double square, double more, double memory) {
  const double keep = std::exp2(-more / memory);
  squares = keep * squares + square;
  amount = keep * amount + more;
}

Matrix6d OdometryModel::covariance(const Pose& step) const {
  const Motion motion = motion_of(step);
  const double translation = rest_translation_.value() + translation_.value() * motion.translation;
  const double rotation = rest_rotation_.value() + rotation_.value() * motion.rotation;
  Vector6d variances;
  variances << translation, translation, translation, rotation, rotation, rotation;
  if (space_ == Space::se2) variances.segment<3>(2).setZero();
  return variances.asDiagonal();
}

void OdometryModel::learn(const Pose& odometry_step, const Pose& measured_step) {
  const Motion motion = motion_of(odometry_step);
  const Vector6d error = boxminus(measured_step, odometry_step);
  const double translation = error.head<3>().squaredNorm() / (space_ == Space::se2 ? 2 : 3);
  const double rotation = error.tail<3>().squaredNorm() / (space_ == Space::se2 ? 1 : 3);
  if (is_rest(odometry_step)) {
    rest_translation_.add(translation, 1, kRestMemory);
    rest_rotation_.add(rotation, 1, kRestMemory);
  } else {
    translation_.add(translation, motion.translation, kMemory);
    rotation_.add(rotation, motion.rotation, kMemory);
  }
}

OdometryModel OdometryModel::of_unknown_motion(Space space) {
  OdometryModel model(space);
  // A robot that drives off, or turns, within one step.
  model.rest_translation_ = {5 * 0.1, 5};
  model.rest_rotation_ = {5 * 0.05, 5};
  return model;
}

bool OdometryModel::is_rest(const Pose& step) {
  return motion_of(step).translation < kRest;
}

bool OdometryModel::is_motion(const Pose& step) {
  return step.translation.allFinite() && step.rotation.coeffs().allFinite() &&
         step.translation.norm() <= kLargestStep_m;
}

}  // namespace hmt::submap
