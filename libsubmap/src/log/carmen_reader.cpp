// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "carmen_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "../observation/median.hpp"
#include "range_scan.hpp"
#include "report_book.hpp"
#include "text_fields.hpp"

namespace hmt::submap {
namespace {

using graph::relative_pose;

constexpr size_t kScansAhead = 200;
/// Beyond it every known scanner means "nothing met" (81.83 to 81.91 m for SICK).
constexpr double kDefaultMaxRange = 80;
/// A file without a known message in so many lines is no CARMEN log.
constexpr int64_t kLinesToKnowFormat = 1000;
/// Scans of two lasers so close in time are one observation.
constexpr double kSameObservation = 0.2;  // seconds
/// A laser does not move on its robot by more; and no robot is longer.
constexpr double kMountShift = 0.05;  // metres
constexpr double kMountTurn = 0.05;   // radians
constexpr double kMaxMount = 3;       // metres

bool near(const Pose& T_a, const Pose& T_b) {
  const Pose T_b_a = relative_pose(T_b, T_a);
  return T_b_a.translation.norm() <= kMountShift && std::abs(T_b_a.yaw_rad()) <= kMountTurn;
}

/// Component-wise median: the mount, whatever a few records say.
Pose median_pose(const std::vector<Pose>& poses) {
  std::array<std::vector<double>, 3> parts;
  const double yaw_0 = poses.front().yaw_rad();
  for (const Pose& pose : poses) {
    parts[0].push_back(pose.translation.x());
    parts[1].push_back(pose.translation.y());
    parts[2].push_back(graph::wrap_angle(pose.yaw_rad() - yaw_0));
  }
  return Pose::planar(median(parts[0]), median(parts[1]), yaw_0 + median(parts[2]));
}

}  // namespace

CarmenReader::CarmenReader(const std::filesystem::path& path)
    : lines_(path), bytes_total_(static_cast<int64_t>(std::filesystem::file_size(path))) {
  while (ahead_.size() < kScansAhead && read_scan()) {
  }
  if (ahead_.empty())
    throw InputError(path.string() + ": " + std::to_string(lines_.line_number()) +
                     " lines and no usable laser scan (FLASER or ROBOTLASER1)" +
                     first_loss(report_));
  learn_odometry();
  learn_mounts();
}

std::optional<Observation> CarmenReader::next() {
  while (ahead_.size() < 2 && read_scan()) {
  }
  if (ahead_.empty()) return std::nullopt;
  const Scan scan = std::move(ahead_.front());
  ahead_.pop_front();
  note_stamp(scan);

  Observation observation;
  observation.index = report_.observations++;
  observation.stamp_s = scan.record.stamp_s.value_or(0);
  observation.T_odom_robot = T_odom_robot(scan);
  observation.readings.push_back(reading(scan, observation.T_odom_robot));
  if (!ahead_.empty() && belongs_to(ahead_.front(), scan)) {
    observation.readings.push_back(reading(ahead_.front(), observation.T_odom_robot));
    ahead_.pop_front();
  }
  return observation;
}

bool CarmenReader::read_scan() {
  const size_t before = ahead_.size();
  while (ahead_.size() == before) {
    const auto line = lines_.next();
    if (!line) {
      if (!lines_.damage().empty() && !report_.losses.contains(lines_.damage()))
        lose(lines_.damage(), lines_.place());
      return false;
    }
    // What a damaged archive gives last is no whole line.
    if (!lines_.line_is_complete() && !lines_.damage().empty()) continue;
    std::string_view fields = *line;
    const std::string_view message = take_field(fields);
    if (!message.empty() && !message.starts_with('#')) read_record(message, fields);
    if (!known_message_seen_ && lines_.line_number() > kLinesToKnowFormat)
      throw InputError(lines_.path().string() +
                       ": no CARMEN message in the first lines; unknown log format");
  }
  return true;
}

void CarmenReader::read_record(std::string_view message, std::string_view fields) {
  const bool known = message == "ODOM" || message == "PARAM" || message == "SYNC" ||
                     message == "TRUEPOS" || message.find("LASER") != std::string_view::npos;
  known_message_seen_ = known_message_seen_ || known;
  try {
    if (message == "FLASER" || message == "RLASER") {
      keep_scan(message == "FLASER" ? 0 : 1, message, parse_flaser(fields));
    } else if (message == "ROBOTLASER1" || message == "ROBOTLASER2") {
      keep_scan(message == "ROBOTLASER1" ? 0 : 1, message, parse_robotlaser(fields));
    } else if (message == "ODOM") {
      ++report_.odometry_records;
    } else if (message == "PARAM") {
      if (const auto value = parse_max_range_param(fields)) max_range_param_m_ = value;
    } else if (message.starts_with("RAWLASER")) {
      note("RAWLASER records left out: they carry no pose", lines_.place());
    } else if (!known) {
      note("lines of unknown messages left out", lines_.place());
    }
  } catch (const std::invalid_argument& error) {
    lose("damaged " + std::string(message) + " records: " + error.what(), lines_.place());
  }
}

void CarmenReader::keep_scan(int sensor, std::string_view message, CarmenScan record) {
  Laser& laser = lasers_[sensor];
  if (laser.message.empty()) laser.message = message;
  if (laser.message != message) {
    note(std::string(message) + " records left out: the same laser as " + laser.message,
         lines_.place());
    return;
  }
  if (!stamp_fields_) stamp_fields_ = record.stamp_fields;
  if (record.stamp_fields != *stamp_fields_) throw std::invalid_argument("wrong number of fields");
  if (laser.beams && *laser.beams != record.ranges_m.size())
    note("changes of the number of beams", lines_.place());
  laser.beams = record.ranges_m.size();
  laser.limit.add(record.ranges_m, record.T_odom_laser.translation.head<2>());
  ahead_.push_back({sensor, lines_.place(), std::move(record)});
}

void CarmenReader::learn_odometry() {
  const CarmenScan& first = ahead_.front().record;
  odometry_is_frozen_ = ahead_.size() > 1;
  double laser_travel_m = 0;
  for (const Scan& scan : ahead_) {
    if (!(scan.record.T_odom_robot == first.T_odom_robot)) odometry_is_frozen_ = false;
    const Pose moved = relative_pose(first.T_odom_laser, scan.record.T_odom_laser);
    if (scan.sensor == ahead_.front().sensor)
      laser_travel_m = std::max(laser_travel_m, moved.translation.norm());
  }
  odometry_is_frozen_ = odometry_is_frozen_ && laser_travel_m > kMountShift;
  if (odometry_is_frozen_)
    note("robot poses stand still: the laser poses are taken for the odometry",
         ahead_.front().place);
}

void CarmenReader::learn_mounts() {
  if (odometry_is_frozen_) return;
  for (auto& [sensor, laser] : lasers_) {
    std::vector<Pose> mounts;
    for (const Scan& scan : ahead_)
      if (scan.sensor == sensor)
        mounts.push_back(relative_pose(scan.record.T_odom_robot, scan.record.T_odom_laser));
    if (mounts.empty()) continue;
    const Pose middle = median_pose(mounts);
    const auto agreeing =
        std::ranges::count_if(mounts, [&](const Pose& mount) { return near(mount, middle); });
    const bool rides = middle.translation.norm() <= kMaxMount &&
                       2 * agreeing > static_cast<std::ptrdiff_t>(mounts.size());
    if (rides) laser.T_robot_laser = middle;
  }
}

Pose CarmenReader::T_odom_robot(const Scan& scan) const {
  return odometry_is_frozen_ ? scan.record.T_odom_laser : scan.record.T_odom_robot;
}

Pose CarmenReader::T_odom_laser(const Scan& scan) {
  const Pose& T_robot_laser = lasers_.at(scan.sensor).T_robot_laser;
  if (odometry_is_frozen_) return scan.record.T_odom_laser;
  if (near(relative_pose(scan.record.T_odom_robot, scan.record.T_odom_laser), T_robot_laser))
    return scan.record.T_odom_laser;
  note("laser pose does not ride with the robot: the mount of the first scans is taken",
       scan.place);
  return scan.record.T_odom_robot * T_robot_laser;
}

Reading CarmenReader::reading(const Scan& scan, const Pose& T_odom_robot) {
  const CarmenScan& record = scan.record;
  Reading reading;
  reading.sensor = scan.sensor;
  reading.T_robot_sensor = relative_pose(T_odom_robot, T_odom_laser(scan));
  reading.max_range_m =
      record.max_range_m > 0 ? record.max_range_m : max_range_param_m_.value_or(kDefaultMaxRange);
  if (const auto limit_m = lasers_.at(scan.sensor).limit.limit_m())
    reading.max_range_m = std::min(reading.max_range_m, *limit_m);
  if (record.ranges_m.empty()) note("scans without beams", scan.place);
  const UsedRanges used =
      add_ranges(record.ranges_m, record.start_angle_rad, record.beam_step_rad, reading);
  note("ranges left out: not a number", scan.place, used.not_a_number);
  note("ranges left out: zero or negative", scan.place, used.not_positive);
  return reading;
}

bool CarmenReader::belongs_to(const Scan& scan, const Scan& front) const {
  if (scan.sensor == front.sensor) return false;
  if (!scan.record.stamp_s || !front.record.stamp_s) return true;
  return std::abs(*scan.record.stamp_s - *front.record.stamp_s) <= kSameObservation;
}

void CarmenReader::note_stamp(const Scan& scan) {
  const auto& stamp_s = scan.record.stamp_s;
  if (!stamp_s) {
    note("stamps absent", scan.place);
  } else if (last_stamp_s_ && *stamp_s < *last_stamp_s_) {
    note("stamps run backwards", scan.place);
  } else if (last_stamp_s_ && *stamp_s == *last_stamp_s_) {
    note("stamps repeated", scan.place);
  }
  last_stamp_s_ = stamp_s;
}

void CarmenReader::note(const std::string& what, const std::string& place, int64_t times) {
  if (times == 0) return;
  report_.notes[what] += times;
  report_.first_places.try_emplace(what, place);
}

void CarmenReader::lose(const std::string& what, const std::string& place) {
  ++report_.losses[what];
  report_.first_places.try_emplace(what, place);
}

}  // namespace hmt::submap
