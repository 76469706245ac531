// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::test {

/// Distance along the ray to the box, from outside or from inside; infinite where it misses it.
inline double ray_range(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                        const Eigen::AlignedBox3d& box) {
  double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
  for (int axis = 0; axis < 3; ++axis) {
    const double one = (box.min()[axis] - origin[axis]) / direction[axis];
    const double two = (box.max()[axis] - origin[axis]) / direction[axis];
    enter = std::max(enter, std::min(one, two));
    leave = std::min(leave, std::max(one, two));
  }
  if (leave < 0 || enter > leave) return std::numeric_limits<double>::infinity();
  return enter > 0 ? enter : leave;
}

/// What a spinning lidar without noise sees of a hall with a row of pillars: `rings` beams from -25
/// to 15 degrees of elevation, `columns` a turn, up to 30 m.
inline submap::Reading cloud_of_a_hall(const submap::Pose& T_world_sensor, int rings, int columns) {
  submap::Reading reading;
  reading.max_range_m = 30;
  reading.beam_step_rad = std::numbers::pi / 180 * 40 / rings;
  const Eigen::AlignedBox3d hall(Eigen::Vector3d(-20, -6.3, -1.1), Eigen::Vector3d(60, 7.2, 3.4));
  for (int i = 0; i < rings * columns; ++i) {
    const double elevation = std::numbers::pi / 180 * (-25 + 40.0 * (i / columns + 0.5) / rings);
    const double azimuth = 2 * std::numbers::pi * (i % columns + 0.5) / columns;
    const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                               std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    const Eigen::Vector3d direction = T_world_sensor.rotation * beam;
    double range = ray_range(T_world_sensor.translation, direction, hall);
    for (int pillar = 0; pillar < 10; ++pillar) {
      const Eigen::Vector3d foot(-15 + 7.0 * pillar, pillar % 2 == 0 ? 3 : -3.5, -2);
      range = std::min(range, ray_range(T_world_sensor.translation, direction,
                                        {foot, foot + Eigen::Vector3d(0.6, 0.8, 6)}));
    }
    if (range < reading.max_range_m) reading.points_sensor.push_back((range * beam).cast<float>());
  }
  return reading;
}

}  // namespace hmt::test
