// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "wheel_odometry.hpp"

#include <cmath>

namespace hmt::submap {
namespace {

constexpr double kLengthBias = 0.01;
constexpr double kDriftBias = 0.002;  // radians per metre
constexpr double kTurnBias = 0.01;
// Standard deviations after one metre or one radian.
constexpr double kLengthNoise = 0.02;  // metres
constexpr double kDriftNoise = 0.01;   // radians
constexpr double kTurnNoise = 0.02;    // radians

}  // namespace

WheelOdometry::WheelOdometry(const Pose& T_world_robot, Random& random)
    : T_world_robot_(T_world_robot),
      length_bias_(random.normal(kLengthBias)),
      drift_bias_rad_per_m_(random.normal(kDriftBias)),
      turn_bias_(random.normal(kTurnBias)) {}

Pose WheelOdometry::measure(const Pose& T_world_robot, Random& random) {
  const Pose step = graph::relative_pose(T_world_robot_, T_world_robot);
  T_world_robot_ = T_world_robot;
  const double driven_m = step.translation.norm();
  const double turned_rad = step.yaw_rad();
  const double length_noise = random.normal(kLengthNoise * std::sqrt(driven_m));
  const double scale = driven_m > 0 ? 1 + length_bias_ + length_noise / driven_m : 1;
  const double yaw_rad = turned_rad * (1 + turn_bias_) + driven_m * drift_bias_rad_per_m_ +
                         random.normal(kDriftNoise * std::sqrt(driven_m)) +
                         random.normal(kTurnNoise * std::sqrt(std::abs(turned_rad)));
  T_odom_robot_ = T_odom_robot_ *
                  Pose::planar(scale * step.translation.x(), scale * step.translation.y(), yaw_rad);
  return T_odom_robot_;
}

}  // namespace hmt::submap
