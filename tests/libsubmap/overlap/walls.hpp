// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::test {

/// A wall between two points of the plane.
struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

/// Distance from the origin of the ray to the wall; nothing where it does not meet it.
inline std::optional<double> ray_range(const Eigen::Vector2d& origin,
                                       const Eigen::Vector2d& direction, const Wall& wall) {
  Eigen::Matrix2d m;
  m << direction, wall.from - wall.to;
  if (std::abs(m.determinant()) < 1e-12) return std::nullopt;
  const Eigen::Vector2d solution = m.inverse() * (wall.from - origin);
  if (solution[0] <= 0 || solution[1] < 0 || solution[1] > 1) return std::nullopt;
  return solution[0];
}

/// What a scanner without noise at the pose sees of the walls up to 20 m: `beams` over `field_rad`
/// about the heading.
inline submap::Reading scan_walls(const std::vector<Wall>& walls, const submap::Pose& T_world_robot,
                                  int beams = 181, double field_rad = std::numbers::pi) {
  submap::Reading reading;
  reading.max_range_m = 20;
  reading.beam_step_rad = field_rad / (beams - 1);
  for (int i = 0; i < beams; ++i) {
    const double bearing = -field_rad / 2 + i * reading.beam_step_rad;
    const double heading = T_world_robot.yaw_rad() + bearing;
    std::optional<double> nearest;
    for (const Wall& wall : walls) {
      const auto range = ray_range(T_world_robot.translation.head<2>(),
                                   {std::cos(heading), std::sin(heading)}, wall);
      if (range && *range < nearest.value_or(reading.max_range_m)) nearest = range;
    }
    const Eigen::Vector3d beam(std::cos(bearing), std::sin(bearing), 0);
    if (nearest) {
      reading.points_sensor.push_back((*nearest * beam).cast<float>());
    } else {
      reading.misses_sensor.push_back(beam.cast<float>());
    }
  }
  return reading;
}

/// The four walls of a room.
inline std::vector<Wall> room(double x_min, double y_min, double x_max, double y_max) {
  return {{{x_min, y_min}, {x_max, y_min}},
          {{x_max, y_min}, {x_max, y_max}},
          {{x_max, y_max}, {x_min, y_max}},
          {{x_min, y_max}, {x_min, y_min}}};
}

}  // namespace hmt::test
