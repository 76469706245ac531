// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::test {

/// A straight wall in the plane.
struct Wall {
  Eigen::Vector2d from, to;
};

/// A planar laser: `beams` over [-pi/2, pi/2] (or all around).
struct Laser {
  int beams = 361;
  double field_of_view_rad = std::numbers::pi;
  double max_range_m = 30;
  double noise_m = 0;
};

/// Distance along the ray to the nearest wall; infinity without one.
inline double ray_range_m(const std::vector<Wall>& walls, const Eigen::Vector2d& origin,
                          const Eigen::Vector2d& direction) {
  double range_m = std::numeric_limits<double>::infinity();
  for (const Wall& wall : walls) {
    const Eigen::Vector2d edge = wall.to - wall.from, start = wall.from - origin;
    const double det = direction.y() * edge.x() - direction.x() * edge.y();
    if (std::abs(det) < 1e-12) continue;
    const double along_ray = (start.y() * edge.x() - start.x() * edge.y()) / det;
    const double along_wall = (direction.x() * start.y() - direction.y() * start.x()) / det;
    if (along_ray > 1e-6 && along_wall >= 0 && along_wall <= 1)
      range_m = std::min(range_m, along_ray);
  }
  return range_m;
}

/// A reading without points.
inline submap::Reading empty_reading(double beam_step_rad) {
  submap::Reading reading;
  reading.max_range_m = 30;
  reading.beam_step_rad = beam_step_rad;
  return reading;
}

/// What the laser, at the robot's origin, sees of the walls from T_world_robot.
inline submap::Observation scan(const std::vector<Wall>& walls, const submap::Pose& T_world_robot,
                                const Laser& laser, std::mt19937& random) {
  std::normal_distribution<double> noise(0, 1);
  submap::Reading reading;
  reading.max_range_m = laser.max_range_m;
  reading.beam_step_rad = laser.field_of_view_rad / (laser.beams - 1);
  for (int i = 0; i < laser.beams; ++i) {
    const double bearing = -laser.field_of_view_rad / 2 + i * reading.beam_step_rad;
    const double heading = T_world_robot.yaw_rad() + bearing;
    const double range_m = ray_range_m(walls, T_world_robot.translation.head<2>(),
                                       {std::cos(heading), std::sin(heading)}) +
                           laser.noise_m * noise(random);
    const Eigen::Vector3f direction(static_cast<float>(std::cos(bearing)),
                                    static_cast<float>(std::sin(bearing)), 0.0F);
    if (range_m < laser.max_range_m)
      reading.points_sensor.push_back(static_cast<float>(range_m) * direction);
    else
      reading.misses_sensor.push_back(direction);
  }
  submap::Observation observation;
  observation.readings.push_back(std::move(reading));
  return observation;
}

/// A spinning lidar: `rings` from -20 to 12 degrees of elevation, all around.
struct Lidar {
  int rings = 16;
  int beams = 180;
  double height_m = 1.5;  ///< above the ground, at the robot's origin
  double max_range_m = 40;
  double noise_m = 0;
};

/// What the lidar, at the robot's origin, sees of walls of that height on level ground. Poses may
/// not tilt.
inline submap::Observation cloud(const std::vector<Wall>& walls, double wall_height_m,
                                 const submap::Pose& T_world_robot, const Lidar& lidar,
                                 std::mt19937& random) {
  constexpr double kDegree = std::numbers::pi / 180;
  std::normal_distribution<double> noise(0, 1);
  submap::Reading reading;
  reading.max_range_m = lidar.max_range_m;
  reading.beam_step_rad = 2 * std::numbers::pi / lidar.beams;
  for (int i = 0; i < lidar.beams; ++i) {
    const double bearing = i * reading.beam_step_rad;
    const double heading = T_world_robot.yaw_rad() + bearing;
    const double wall_m = ray_range_m(walls, T_world_robot.translation.head<2>(),
                                      {std::cos(heading), std::sin(heading)});
    for (int ring = 0; ring < lidar.rings; ++ring) {
      const double elevation = (-20 + 32.0 * ring / (lidar.rings - 1)) * kDegree;
      const double ground_m = elevation < 0 ? -lidar.height_m / std::tan(elevation)
                                            : std::numeric_limits<double>::infinity();
      const bool over = lidar.height_m + wall_m * std::tan(elevation) > wall_height_m;
      const double across_m =
          std::min(ground_m, over ? std::numeric_limits<double>::infinity() : wall_m);
      const double range_m = across_m / std::cos(elevation) + lidar.noise_m * noise(random);
      if (range_m > lidar.max_range_m) continue;
      reading.points_sensor.emplace_back(
          (range_m * Eigen::Vector3d(std::cos(elevation) * std::cos(bearing),
                                     std::cos(elevation) * std::sin(bearing), std::sin(elevation)))
              .cast<float>());
    }
  }
  submap::Observation observation;
  observation.readings.push_back(std::move(reading));
  return observation;
}

/// Two long walls that meet at a right angle at (5, 5), in front and to the left of the origin.
inline std::vector<Wall> right_angle() {
  return {{{5, -20}, {5, 5}}, {{5, 5}, {-20, 5}}};
}

/// Two parallel walls, 2 m apart, along x; no end within sight.
inline std::vector<Wall> corridor() {
  return {{{-200, 1}, {200, 1}}, {{-200, -1}, {200, -1}}};
}

/// A closed room of 10 m x 8 m with a niche, so that no two sides look alike.
inline std::vector<Wall> room() {
  return {{{-4, -3}, {6, -3}}, {{6, -3}, {6, 5}},  {{6, 5}, {2, 5}},   {{2, 5}, {2, 6}},
          {{2, 6}, {-1, 6}},   {{-1, 6}, {-1, 5}}, {{-1, 5}, {-4, 5}}, {{-4, 5}, {-4, -3}}};
}

}  // namespace hmt::test
