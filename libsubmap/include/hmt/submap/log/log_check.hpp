// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hmt/submap/log/log_reader.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// One sensor of a log.
struct SensorSummary {
  int sensor = 0;
  int64_t readings = 0;
  int64_t points = 0;
  int64_t misses = 0;
  int64_t empty_readings = 0;  ///< without a single point
  Pose T_robot_sensor;         ///< of the first reading
  int64_t mount_changes = 0;   ///< readings whose mount is not that of the reading before
  double beam_step_rad = 0;    ///< of the first reading
  double max_range_m = 0;      ///< greatest

  bool operator==(const SensorSummary&) const = default;
};

/// One sensor of landmarks of a log.
struct LandmarkSensorSummary {
  int sensor = 0;
  int64_t readings = 0;
  int64_t sightings = 0;
  int64_t unnamed = 0;     ///< sightings without a name
  int64_t landmarks = 0;   ///< different names
  double max_range_m = 0;  ///< of the farthest sighting

  bool operator==(const LandmarkSensorSummary&) const = default;
};

/// What a log holds and what is odd about it.
struct LogSummary {
  LogReport report;
  Space space = Space::se2;
  double first_stamp_s = 0;  ///< least stamp
  double last_stamp_s = 0;   ///< greatest stamp
  double period_s = 0;       ///< median time between observations
  int64_t gaps = 0;          ///< pauses of more than kGapPeriods periods and kLeastGap
  double largest_gap_s = 0;
  double path_m = 0;  ///< by odometry, jumps left out
  /// Steps of the odometry that no robot can make, faster than kMaxSpeed and longer than
  /// kLeastJump.
  int64_t odometry_jumps = 0;
  int64_t first_jump = 0;  ///< index of the observation after it
  double largest_jump_m = 0;
  std::vector<SensorSummary> sensors;                   ///< by their number
  std::vector<LandmarkSensorSummary> landmark_sensors;  ///< by their number
  /// All that is odd, as sentences: losses first, then notes.
  std::vector<std::string> findings;

  bool operator==(const LogSummary&) const = default;
};

constexpr double kGapPeriods = 10;
constexpr double kLeastGap = 2;   // seconds
constexpr double kMaxSpeed = 15;  // m/s
constexpr double kLeastJump = 2;  // metres

/// Reads the rest of a log. O(observations) time, eight bytes of memory for each observation.
/// Throws InputError where the log cannot be read any further.
LogSummary summarize_log(LogReader& log, const Run& run);

}  // namespace hmt::submap
