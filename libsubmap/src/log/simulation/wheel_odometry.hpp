// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/observation/observation.hpp"
#include "random.hpp"

namespace hmt::submap {

/// Wheel odometry: each step is measured with a constant bias (wheels that are not equal) and with
/// noise whose variance grows with the way driven and the angle turned. Drifts by some metres in
/// 200 m, as the odometry of real logs does.
class WheelOdometry {
 public:
  /// Draws the biases of this robot.
  WheelOdometry(const Pose& T_world_robot, Random& random);

  /// The odometry's pose after the robot has moved to T_world_robot; starts at the identity.
  Pose measure(const Pose& T_world_robot, Random& random);

 private:
  Pose T_world_robot_;
  Pose T_odom_robot_;
  double length_bias_;  ///< per metre driven
  double drift_bias_rad_per_m_;
  double turn_bias_;  ///< per radian turned
};

}  // namespace hmt::submap
