// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// A robot that drives straight from corner to corner and turns on the spot, lap after lap.
class RobotPath {
 public:
  static constexpr double kSpeed = 0.7;     // m/s
  static constexpr double kTurnRate = 0.5;  // rad/s

  RobotPath(std::function<std::vector<Eigen::Vector2d>(int lap)> corners_of_lap, int laps);

  /// The true pose, at first at the first corner.
  Pose T_world_robot() const { return Pose::planar(p_world_.x(), p_world_.y(), yaw_rad_); }
  /// Drives on for so long; false where the last lap is done.
  bool advance(double duration_s);
  int laps_begun() const { return laps_begun_; }

 private:
  bool find_corner();

  std::function<std::vector<Eigen::Vector2d>(int lap)> corners_of_lap_;
  int laps_;
  int laps_begun_ = 0;
  std::deque<Eigen::Vector2d> corners_;
  Eigen::Vector2d p_world_;
  double yaw_rad_ = 0;
};

}  // namespace hmt::submap
