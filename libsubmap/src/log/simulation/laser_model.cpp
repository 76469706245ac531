// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "laser_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace hmt::submap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double beam_of(double angle_rad) {
  return (angle_rad / kDegree - LaserModel::kStartAngleDeg) / LaserModel::kBeamStepDeg;
}

/// Shortens the distances of the beams from number `begin` to `end` that meet the line.
void meet_line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double begin, double end,
               std::vector<double>& distances_m) {
  constexpr double kRounding = 1e-9;  // so that no beam slips through where two walls join
  const int first = std::max(0, static_cast<int>(std::ceil(begin - kRounding)));
  for (int i = first; i < LaserModel::kBeams && i <= end + kRounding; ++i) {
    const double angle_rad = (LaserModel::kStartAngleDeg + i * LaserModel::kBeamStepDeg) * kDegree;
    const Eigen::Vector2d beam(std::cos(angle_rad), std::sin(angle_rad));
    // The point r * beam on the line: cross(r * beam - from, to - from) = 0.
    const double distance_m = cross(from, to - from) / cross(beam, to - from);
    auto& nearest_m = distances_m[static_cast<size_t>(i)];
    if (distance_m > 0) nearest_m = std::min(nearest_m, distance_m);
  }
}

/// The same for a wall, its ends in the frame of the laser.
void meet(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
          std::vector<double>& distances_m) {
  const double area = cross(from, to);
  if (std::abs(area) < 1e-12) return;  // seen edge on
  const Eigen::Vector2d& right = area > 0 ? from : to;
  const Eigen::Vector2d& left = area > 0 ? to : from;
  const double turn = 360 / LaserModel::kBeamStepDeg;
  const double begin = beam_of(std::atan2(right.y(), right.x()));
  double end = beam_of(std::atan2(left.y(), left.x()));
  if (end < begin) {  // it reaches over the direction straight back
    end += turn;
    meet_line(from, to, begin - turn, end - turn, distances_m);
  }
  meet_line(from, to, begin, end, distances_m);
}

}  // namespace

std::vector<double> LaserModel::distances(const Pose& T_world_laser) const {
  std::vector<double> distances_m(kBeams, std::numeric_limits<double>::infinity());
  const Eigen::Vector2d p_world = T_world_laser.translation.head<2>();
  const Eigen::Matrix2d R_laser_world =
      Eigen::Rotation2Dd(-T_world_laser.yaw_rad()).toRotationMatrix();
  for (const Wall& wall : walls_)
    meet(R_laser_world * (wall.from - p_world), R_laser_world * (wall.to - p_world), distances_m);
  return distances_m;
}

std::vector<double> LaserModel::scan(const Pose& T_world_laser, Random& random) const {
  std::vector<double> ranges_m = distances(T_world_laser);
  for (double& range_m : ranges_m) {
    const double measured_m = range_m + random.normal(kNoise);
    const bool lost = random.uniform() < kLostShare;
    range_m = lost || measured_m >= kMaxRange ? kMissCode
                                              : std::max(0.01, std::round(measured_m * 100) / 100);
  }
  return ranges_m;
}

}  // namespace hmt::submap
