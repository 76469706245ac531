// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "pose_history.hpp"
#include "turn_rates.hpp"

namespace hmt::submap {

/// How a sensor moved while it took one scan or cloud beam by beam: by the odometry, and where
/// there is a gyroscope by how that says it turned.
class Sweep {
 public:
  /// From the first to the last of the times of the beams, seconds after the scan's stamp. Nothing
  /// where the odometry does not reach over all of it.
  static std::optional<Sweep> along(const PoseHistory& odometry, const TurnRates& turn_rates,
                                    int64_t stamp_ns, double first_s, double last_s,
                                    const graph::Pose& T_robot_sensor);

  /// The pose of the sensor at that time in its frame at the stamp of the scan.
  graph::Pose T_stamp_then(double offset_s) const;

 private:
  /// Poses at equal steps in between; odometry bends little in a twentieth of a scan.
  static constexpr size_t kSteps = 20;

  double first_s_ = 0;
  double step_s_ = 0;
  std::array<graph::Pose, kSteps + 1> T_stamp_then_;
};

/// The times of the beams or points of a scan, seconds after its stamp: as they were given, in
/// seconds or parts of it, after the stamp or since some beginning. Empty where they cannot be the
/// times of one scan, which takes a second at most.
std::vector<float> beam_times(std::span<const double> given, bool in_nanoseconds, int64_t stamp_ns);

}  // namespace hmt::submap
