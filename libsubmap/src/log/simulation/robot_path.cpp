// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot_path.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

constexpr double kArrived = 1e-9;  // metres, and radians

double heading_rad(const Eigen::Vector2d& direction) {
  return std::atan2(direction.y(), direction.x());
}

}  // namespace

RobotPath::RobotPath(std::function<std::vector<Eigen::Vector2d>(int lap)> corners_of_lap, int laps)
    : corners_of_lap_(std::move(corners_of_lap)), laps_(laps) {
  p_world_ = corners_of_lap_(0).front();
  if (find_corner()) yaw_rad_ = heading_rad(corners_.front() - p_world_);
}

/// Drops corners that are reached, begins laps; false where nothing is left.
bool RobotPath::find_corner() {
  while (true) {
    while (!corners_.empty() && (corners_.front() - p_world_).norm() < kArrived)
      corners_.pop_front();
    if (!corners_.empty()) return true;
    if (laps_begun_ == laps_) return false;
    const auto corners = corners_of_lap_(laps_begun_++);
    corners_.assign(corners.begin(), corners.end());
  }
}

bool RobotPath::advance(double duration_s) {
  while (duration_s > 0) {
    if (!find_corner()) return false;
    const Eigen::Vector2d way = corners_.front() - p_world_;
    const double turn_rad = graph::wrap_angle(heading_rad(way) - yaw_rad_);
    if (std::abs(turn_rad) > kArrived) {
      const double turned_rad = std::min(std::abs(turn_rad), kTurnRate * duration_s);
      yaw_rad_ += std::copysign(turned_rad, turn_rad);
      duration_s -= turned_rad / kTurnRate;
    } else {
      const double driven_m = std::min(way.norm(), kSpeed * duration_s);
      p_world_ += driven_m * way.normalized();
      duration_s -= driven_m / kSpeed;
    }
  }
  return true;
}

}  // namespace hmt::submap
