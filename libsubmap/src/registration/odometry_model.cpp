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
// ... but no more than this share of all motion so far.
constexpr double kEarlyShare = 0.25;

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

void OdometryModel::Rate::add(double square, double more, double memory, double weight) {
  const double keep = std::exp2(-weight * more / memory);
  squares = keep * squares + weight * square;
  amount = keep * amount + weight * more;
  seen += weight * more;
}

Vector6d OdometryModel::motion_by_axis(const Pose& step) {
  const Motion motion = motion_of(step);
  Vector6d amounts;
  amounts << Eigen::Vector3d::Constant(motion.translation),
      Eigen::Vector3d::Constant(motion.rotation);
  return amounts;
}

Matrix6d OdometryModel::covariance(const Pose& step) const {
  const Vector6d amounts = motion_by_axis(step);
  Vector6d variances = Vector6d::Zero();
  for (Eigen::Index k = 0; k < 6; ++k)
    if (space_ == Space::se3 || k < 2 || k == 5) {
      const auto i = static_cast<size_t>(k);
      variances[k] = rest_[i].value() + moving_[i].value() * amounts[k];
    }
  return variances.asDiagonal();
}

void OdometryModel::learn(const Pose& odometry_step, const Pose& measured_step,
                          const Vector6d& noise) {
  const bool rest = is_rest(odometry_step);
  const Vector6d amounts = rest ? Vector6d(Vector6d::Ones()) : motion_by_axis(odometry_step);
  const Vector6d known = covariance(odometry_step).diagonal();
  Vector6d squares = boxminus(measured_step, odometry_step).cwiseAbs2();
  if (space_ == Space::se2) squares.head<2>().setConstant(squares.head<2>().mean());
  for (Eigen::Index k = 0; k < 6; ++k) {
    if (known[k] <= 0) continue;
    // The least-squares weight of a squared difference, whose variance is twice its square.
    const double share = known[k] / (known[k] + noise[k]);
    Rate& rate = (rest ? rest_ : moving_)[static_cast<size_t>(k)];
    const double memory = rest ? kRestMemory : kMemory;
    // In space odometry ranges from wheels to inertial units, orders of magnitude apart: the start
    // values are forgotten as fast as anything is learnt.
    rate.add(squares[k] - noise[k], amounts[k],
             space_ == Space::se2 ? memory : std::min(memory, kEarlyShare * rate.seen + amounts[k]),
             share * share);
  }
}

OdometryModel OdometryModel::of_unknown_motion(Space space) {
  OdometryModel model(space);
  // A robot that drives off, or turns, within one step.
  model.rest_ = all({5 * 0.1, 5}, {5 * 0.05, 5});
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
