// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>

namespace hmt::submap {

/// How fast the robot turned lately, by a gyroscope: rad/s about the axes of the robot.
class TurnRates {
 public:
  /// Some seconds of the fastest gyroscopes.
  static constexpr size_t kMost = 8000;
  /// Between rates that lie further apart nothing is known.
  static constexpr int64_t kMaxGap_ns = 100'000'000;

  void add(int64_t stamp_ns, const Eigen::Vector3d& rate_robot);
  /// How the robot stood at the later time, seen from how it stood at the earlier one; the times
  /// may come in any order. Nothing where the rates do not reach over all of it.
  std::optional<Eigen::Quaterniond> turn(int64_t from_ns, int64_t to_ns) const;

 private:
  std::map<int64_t, Eigen::Vector3d> rates_;
};

}  // namespace hmt::submap
