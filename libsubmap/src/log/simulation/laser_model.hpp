// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "floor_plan.hpp"
#include "hmt/submap/observation/observation.hpp"
#include "random.hpp"

namespace hmt::submap {

/// A scanner like the SICK LMS 200: 181 beams over 180 deg, ranges in whole centimetres, a code
/// beyond the maximum where a beam meets nothing.
class LaserModel {
 public:
  static constexpr int kBeams = 181;
  static constexpr double kMaxRange = 80;      // metres
  static constexpr double kMissCode = 81.91;   // metres
  static constexpr double kNoise = 0.01;       // metres, standard deviation
  static constexpr double kLostShare = 0.002;  // beams that come back as misses
  static constexpr double kStartAngleDeg = -90;
  static constexpr double kBeamStepDeg = 1;

  explicit LaserModel(std::vector<Wall> walls) : walls_(std::move(walls)) {}

  /// One scan with noise. O(walls + beams that they cover).
  std::vector<double> scan(const Pose& T_world_laser, Random& random) const;
  /// Exact distances to the nearest walls, infinite where there is none.
  std::vector<double> distances(const Pose& T_world_laser) const;

 private:
  std::vector<Wall> walls_;
};

}  // namespace hmt::submap
