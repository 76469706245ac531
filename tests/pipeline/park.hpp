// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "hmt/graph/pose.hpp"

namespace hmt::test {

/// A robot that drives two rounds on a circle of 20 m, between trees on both sides of its way.
struct Park {
  std::map<int64_t, Eigen::Vector2d> trees;
  std::vector<graph::Pose> T_world_robot;

  /// Writes the log; without names the sensor does not tell which tree it sees.
  explicit Park(const std::filesystem::path& log, bool with_names = true) {
    std::mt19937 generator(1);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 40; ++k) {
      const double angle = 2 * std::numbers::pi * k / 40;
      const double radius = k % 2 == 0 ? 24 : 16.5;
      trees[100 + k] = {radius * std::cos(angle), radius * std::sin(angle)};
    }
    std::ofstream out(log);
    out.precision(17);
    for (int step = 0; step < 500; ++step) {
      const double angle = 4 * std::numbers::pi * step / 500;
      T_world_robot.push_back(graph::Pose::planar(20 * std::cos(angle), 20 * std::sin(angle),
                                                  angle + std::numbers::pi / 2));
      if (step > 0) {
        const graph::Pose T =
            graph::relative_pose(T_world_robot[T_world_robot.size() - 2], T_world_robot.back());
        out << "ODOMETRY " << step - 1 << " " << step << " "
            << T.translation.x() + 0.02 * normal(generator) << " "
            << T.translation.y() + 0.02 * normal(generator) << " "
            << T.yaw_rad() + 0.01 * normal(generator) << " 0.0004 0 0 0.0004 0 0.0001\n";
      }
      for (const auto& [name, p] : trees) {
        const Eigen::Vector3d seen =
            T_world_robot.back().inverse() * Eigen::Vector3d(p.x(), p.y(), 0);
        if (step > 0 && seen.norm() < 9 && seen.x() > 0)
          out << "LANDMARK " << step << " " << (with_names ? std::to_string(name) : "-") << " "
              << seen.x() + 0.1 * normal(generator) << " " << seen.y() + 0.1 * normal(generator)
              << " 0.01 0 0.01\n";
      }
    }
  }
};

}  // namespace hmt::test
