// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_scans.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <unordered_set>

namespace hmt::submap {
namespace {

/// Finer fans than this say nothing more about rooms but cost memory.
constexpr double kLeastStepRad = 0.0087;
/// Far points of a scan lie apart by decimetres and turn with every error of the heading.
constexpr float kMaxRangeM = 20.0F;
/// Surfaces around a lidar outdoors stand farther off than the walls of rooms.
constexpr double kMaxCloudRangeM = 40.0;
/// Vertical part of the normal of what stands upright, to 30 degrees.
constexpr double kMostSlope = 0.5;
constexpr double kScanCellM = 0.05;

int bin_of(const SightFan& fan, double angle_rad) {
  const double bin = (graph::wrap_angle(angle_rad) + std::numbers::pi) / fan.step_rad;
  const int bins = static_cast<int>(fan.range_m.size());
  return std::clamp(static_cast<int>(bin), 0, bins - 1);
}

SightFan make_fan(const Reading& reading) {
  const double turn = 2.0 * std::numbers::pi;
  const double wanted = std::max(reading.beam_step_rad, kLeastStepRad);
  const int bins = std::max(8, static_cast<int>(turn / wanted));
  SightFan fan{reading.T_robot_sensor, turn / bins,
               std::vector<float>(static_cast<size_t>(bins), 0.0F)};
  for (const Eigen::Vector3f& p : reading.points_sensor) {
    float& range = fan.range_m[static_cast<size_t>(bin_of(fan, std::atan2(p.y(), p.x())))];
    const float r = p.head<2>().norm();
    range = range > 0.0F ? std::min(range, r) : r;
  }
  return fan;
}

bool fan_sees_through(const SightFan& fan, const Eigen::Vector2d& p_robot, double margin_m) {
  const Eigen::Vector3d p =
      fan.T_robot_sensor.inverse() * Eigen::Vector3d(p_robot.x(), p_robot.y(), 0.0);
  const double reach = p.head<2>().norm() + margin_m;
  const int bins = static_cast<int>(fan.range_m.size());
  const int bin = bin_of(fan, std::atan2(p.y(), p.x()));
  for (int i = bin - 1; i <= bin + 1; ++i)
    if (fan.range_m[static_cast<size_t>((i + bins) % bins)] < reach) return false;
  return true;
}

}  // namespace

PlanarScan make_planar_scan(const Observation& observation) {
  PlanarScan scan;
  std::vector<Eigen::Vector2f> points;
  for (const Reading& reading : observation.readings) {
    scan.sight.push_back(make_fan(reading));
    for (const Eigen::Vector3f& p_sensor : reading.points_sensor)
      if (p_sensor.norm() < kMaxRangeM)
        points.push_back(
            (reading.T_robot_sensor * p_sensor.cast<double>()).head<2>().cast<float>());
  }
  scan.points_robot = thin_points(points, kScanCellM);
  return scan;
}

PlanarScan make_upright_scan(const Surface& surface, const Pose& T_level_robot) {
  std::vector<Eigen::Vector2f> points;
  for (size_t i = 0; i < surface.size(); ++i) {
    const Eigen::Vector3d& normal = surface.normals_robot[i];
    if (normal.isZero(0)) continue;
    if (std::abs((T_level_robot.rotation * normal).z()) > kMostSlope) continue;
    const Eigen::Vector2d p = (T_level_robot * surface.points_robot[i]).head<2>();
    if (p.norm() < kMaxCloudRangeM) points.emplace_back(p.cast<float>());
  }
  PlanarScan scan;
  scan.points_robot = thin_points(points, kScanCellM);
  return scan;
}

bool sees_through(const PlanarScan& scan, const Eigen::Vector2d& p_robot, double margin_m) {
  return std::any_of(scan.sight.begin(), scan.sight.end(),
                     [&](const SightFan& fan) { return fan_sees_through(fan, p_robot, margin_m); });
}

std::vector<Eigen::Vector2f> thin_points(std::span<const Eigen::Vector2f> points, double cell_m) {
  std::unordered_set<int64_t> seen;
  std::vector<Eigen::Vector2f> kept;
  for (const Eigen::Vector2f& p : points) {
    const auto x = static_cast<int64_t>(std::floor(p.x() / cell_m));
    const auto y = static_cast<int64_t>(std::floor(p.y() / cell_m));
    if (seen.insert(x * (int64_t{1} << 32) + y).second) kept.push_back(p);
  }
  return kept;
}

}  // namespace hmt::submap
