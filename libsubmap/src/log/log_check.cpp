// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/log/log_check.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

namespace hmt::submap {
namespace {

/// Mounts closer than this are one; logs round poses to six decimals.
constexpr double kSameMount = 1e-4;  // metres and radians

std::string number(double value) {
  char digits[64];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 4).ptr;
  return {digits, end};
}

std::string share(int64_t part, int64_t whole) {
  return number(100 * static_cast<double>(part) / static_cast<double>(whole)) + " %";
}

/// Gathers the summary, one observation after the other.
class Collector {
 public:
  void add(const Observation& observation) {
    if (last_) add_step(*last_, observation);
    least_stamp_s_ = std::min(least_stamp_s_, observation.stamp_s);
    greatest_stamp_s_ = std::max(greatest_stamp_s_, observation.stamp_s);
    for (const Reading& reading : observation.readings) add_reading(reading);
    for (const LandmarkReading& reading : observation.landmark_readings) add_reading(reading);
    last_ = {observation.index, observation.stamp_s, observation.T_odom_robot};
  }

  LogSummary finish() {
    if (last_) {
      summary_.first_stamp_s = least_stamp_s_;
      summary_.last_stamp_s = greatest_stamp_s_;
    }
    add_gaps();
    for (const auto& [id, sensor] : sensors_) summary_.sensors.push_back(sensor.summary);
    for (auto& [id, sensor] : landmark_sensors_) {
      sensor.summary.landmarks = static_cast<int64_t>(sensor.names.size());
      summary_.landmark_sensors.push_back(sensor.summary);
    }
    return std::move(summary_);
  }

 private:
  struct Step {
    int64_t index = 0;
    double stamp_s = 0;
    Pose T_odom_robot;
  };
  struct Sensor {
    SensorSummary summary;
    Pose T_robot_sensor;
  };

  struct LandmarkSensor {
    LandmarkSensorSummary summary;
    std::set<int64_t> names;
  };

  void add_step(const Step& from, const Observation& to) {
    const double duration_s = to.stamp_s - from.stamp_s;
    durations_s_.push_back(duration_s);
    const double step_m = (to.T_odom_robot.translation - from.T_odom_robot.translation).norm();
    if (step_m <= std::max(kLeastJump, kMaxSpeed * std::abs(duration_s))) {
      summary_.path_m += step_m;
      return;
    }
    if (summary_.odometry_jumps++ == 0) summary_.first_jump = to.index;
    summary_.largest_jump_m = std::max(summary_.largest_jump_m, step_m);
  }

  void add_reading(const Reading& reading) {
    const auto [place, is_new] = sensors_.try_emplace(reading.sensor);
    auto& [summary, T_robot_sensor] = place->second;
    if (is_new) {
      summary.sensor = reading.sensor;
      summary.T_robot_sensor = reading.T_robot_sensor;
      summary.beam_step_rad = reading.beam_step_rad;
    } else if (boxminus(reading.T_robot_sensor, T_robot_sensor).norm() > kSameMount) {
      ++summary.mount_changes;
    }
    T_robot_sensor = reading.T_robot_sensor;
    ++summary.readings;
    summary.points += static_cast<int64_t>(reading.points_sensor.size());
    summary.misses += static_cast<int64_t>(reading.misses_sensor.size());
    if (reading.points_sensor.empty()) ++summary.empty_readings;
    summary.max_range_m = std::max(summary.max_range_m, reading.max_range_m);
  }

  void add_reading(const LandmarkReading& reading) {
    auto& [summary, names] = landmark_sensors_[reading.sensor];
    summary.sensor = reading.sensor;
    ++summary.readings;
    for (const Landmark& landmark : reading.landmarks) {
      ++summary.sightings;
      if (landmark.id == kUnknownLandmark)
        ++summary.unnamed;
      else
        names.insert(landmark.id);
      summary.max_range_m = std::max(summary.max_range_m, landmark.position_sensor.norm());
    }
  }

  void add_gaps() {
    if (durations_s_.empty()) return;
    std::vector<double> sorted = durations_s_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    summary_.period_s = *middle;
    const double gap_s = std::max(kLeastGap, kGapPeriods * summary_.period_s);
    for (const double duration_s : durations_s_) {
      if (duration_s > gap_s) ++summary_.gaps;
      summary_.largest_gap_s = std::max(summary_.largest_gap_s, duration_s);
    }
  }

  LogSummary summary_;
  std::map<int, Sensor> sensors_;
  std::map<int, LandmarkSensor> landmark_sensors_;
  std::optional<Step> last_;
  std::vector<double> durations_s_;
  double least_stamp_s_ = std::numeric_limits<double>::infinity();
  double greatest_stamp_s_ = -std::numeric_limits<double>::infinity();
};

void find_in_report(LogSummary& summary) {
  const LogReport& report = summary.report;
  for (const auto* kind : {&report.losses, &report.notes})
    for (const auto& [what, times] : *kind)
      summary.findings.push_back((kind == &report.losses ? "loss: " : "") + what + " (" +
                                 std::to_string(times) + ", first at " +
                                 report.first_places.at(what) + ")");
  if (report.observations > 1 && summary.first_stamp_s == summary.last_stamp_s &&
      !report.notes.contains("stamps absent"))
    summary.findings.push_back("all stamps are equal: no clock");
}

void find_in_motion(LogSummary& summary) {
  auto& findings = summary.findings;
  if (summary.report.observations == 1) findings.push_back("a single observation");
  if (summary.gaps > 0)
    findings.push_back(std::to_string(summary.gaps) + " gaps in time, the longest of " +
                       number(summary.largest_gap_s) + " s");
  if (summary.odometry_jumps > 0)
    findings.push_back(std::to_string(summary.odometry_jumps) +
                       " jumps of the odometry, the longest of " + number(summary.largest_jump_m) +
                       " m, the first before observation " + std::to_string(summary.first_jump));
}

void find_in_sensors(LogSummary& summary) {
  for (const SensorSummary& sensor : summary.sensors) {
    const std::string name = "sensor " + std::to_string(sensor.sensor) + ": ";
    const int64_t beams = sensor.points + sensor.misses;
    if (sensor.points == 0) {
      summary.findings.push_back(name + "no points at all");
      continue;
    }
    if (sensor.empty_readings > 0)
      summary.findings.push_back(name + share(sensor.empty_readings, sensor.readings) +
                                 " of the readings have no point");
    if (2 * sensor.misses > beams)
      summary.findings.push_back(name + share(sensor.misses, beams) + " of the beams met nothing");
    if (sensor.mount_changes > 0)
      summary.findings.push_back(name + "its mount changes " +
                                 std::to_string(sensor.mount_changes) + " times");
  }
}

}  // namespace

LogSummary summarize_log(LogReader& log, const Run& run) {
  Collector collector;
  while (const auto observation = log.next()) {
    if (run.stop_requested()) throw Interrupted{};
    collector.add(*observation);
    run.report(
        {"read", static_cast<double>(log.bytes_read()), static_cast<double>(log.bytes_total())});
  }
  LogSummary summary = collector.finish();
  summary.report = log.report();
  summary.space = log.space();
  find_in_report(summary);
  find_in_motion(summary);
  find_in_sensors(summary);
  return summary;
}

}  // namespace hmt::submap
