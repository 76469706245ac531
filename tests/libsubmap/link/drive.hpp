// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <vector>

#include "../registration/scene.hpp"
#include "hmt/submap/link/loop_search.hpp"

namespace hmt::test {

/// A robot that drives past walls with an odometry that drifts, and what the loop search gets.
struct Drive {
  std::vector<submap::Pose> truth;
  std::vector<submap::Pose> estimate;
  std::vector<submap::Keyframe> keyframes;
  std::vector<int> submap;
  std::vector<double> path_m;
  std::vector<submap::Observation> observations;
};

/// Drift of the odometry, for each metre of travel.
struct Drift {
  double along_m = 0;  ///< added to every metre
  double yaw_rad = 0;
};

/// From corner to corner, a keyframe every 0.5 m and every 0.3 rad, headings along the way.
inline std::vector<submap::Pose> drive_along(const std::vector<Eigen::Vector2d>& corners) {
  std::vector<submap::Pose> poses;
  for (size_t i = 0; i + 1 < corners.size(); ++i) {
    const Eigen::Vector2d way = corners[i + 1] - corners[i];
    const double yaw = std::atan2(way.y(), way.x());
    if (!poses.empty()) {
      const double turn = graph::wrap_angle(yaw - poses.back().yaw_rad());
      const int steps = static_cast<int>(std::abs(turn) / 0.3);
      for (int k = 1; k <= steps; ++k)
        poses.push_back(submap::Pose::planar(corners[i].x(), corners[i].y(),
                                             yaw - turn * (1.0 - k / (steps + 1.0))));
    }
    const int steps = static_cast<int>(way.norm() / 0.5);
    for (int k = 0; k < steps; ++k) {
      const Eigen::Vector2d p = corners[i] + way * k / steps;
      poses.push_back(submap::Pose::planar(p.x(), p.y(), yaw));
    }
  }
  return poses;
}

inline Drive drive(const std::vector<Wall>& walls, const std::vector<Eigen::Vector2d>& corners,
                   const Drift& drift, const Laser& laser) {
  Drive result;
  result.truth = drive_along(corners);
  std::mt19937 random(3);
  for (size_t k = 0; k < result.truth.size(); ++k) {
    const int id = static_cast<int>(k);
    double moved_m = 0;
    submap::Pose step;
    if (k > 0) {
      step = graph::relative_pose(result.truth[k - 1], result.truth[k]);
      moved_m = step.translation.norm();
      step = step * submap::Pose::planar(drift.along_m * moved_m, 0, drift.yaw_rad * moved_m);
    }
    result.path_m.push_back((k > 0 ? result.path_m.back() : 0.0) + moved_m);
    result.estimate.push_back(k > 0 ? result.estimate.back() * step : result.truth[0]);
    result.submap.push_back(0);
    result.observations.push_back(scan(walls, result.truth[k], laser, random));
    result.observations.back().index = id;
    result.keyframes.push_back({id, id, 0.1 * id, result.estimate.back()});
  }
  return result;
}

}  // namespace hmt::test
