// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/observation/observation.hpp"

#include <algorithm>

namespace hmt::submap {

bool is_cloud(const Reading& reading) {
  return std::any_of(reading.points_sensor.begin(), reading.points_sensor.end(),
                     [](const Eigen::Vector3f& p) { return p.z() != 0.0F; });
}

std::vector<Eigen::Vector3d> points_in_robot(const Observation& observation) {
  std::vector<Eigen::Vector3d> points_robot;
  for (const Reading& reading : observation.readings)
    for (const Eigen::Vector3f& p_sensor : reading.points_sensor)
      points_robot.push_back(reading.T_robot_sensor * p_sensor.cast<double>());
  return points_robot;
}

}  // namespace hmt::submap
