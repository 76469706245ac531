// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "carmen_record.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "text_fields.hpp"

namespace hmt::submap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// More than any planar scanner has; a greater count is damage.
constexpr int64_t kMaxBeams = 100000;
/// No robot drives and no scanner sees farther; greater numbers are damage, and their squares and
/// sines would be no numbers.
constexpr double kFarthestPose = 1e8;   // metres
constexpr double kFarthestRange = 1e4;  // metres
constexpr double kLargestAngle = 1e3;   // radians

int64_t take_beam_count(std::string_view& fields, const char* name) {
  const int64_t count = take_count(fields, name);
  if (count > kMaxBeams) throw std::invalid_argument(std::string(name) + " is not a count");
  return count;
}

std::vector<double> take_numbers(std::string_view& fields, const char* name) {
  // A line has at least two characters a number, so a lying count reserves no more than the line.
  const int64_t count = take_beam_count(fields, "number of readings");
  std::vector<double> values;
  values.reserve(std::min(static_cast<size_t>(count), fields.size() / 2 + 1));
  for (int64_t i = 0; i < count; ++i) values.push_back(take_number(fields, name));
  return values;
}

double take_below(std::string_view& fields, const char* name, double limit) {
  const double value = take_finite(fields, name);
  if (std::abs(value) > limit) throw std::invalid_argument(std::string(name) + " is far too large");
  return value;
}

graph::Pose take_pose(std::string_view& fields, const char* name) {
  const double x = take_below(fields, name, kFarthestPose);
  const double y = take_below(fields, name, kFarthestPose);
  return graph::Pose::planar(x, y, take_below(fields, name, kLargestAngle));
}

void take_stamp(CarmenScan& scan, std::string_view& fields) {
  for (; scan.stamp_fields < 3; ++scan.stamp_fields) {
    std::string_view rest = fields;
    if (take_field(rest).empty()) return;
    if (scan.stamp_fields == 0) scan.stamp_s = take_finite(fields, "stamp");
    fields = scan.stamp_fields == 0 ? fields : rest;
  }
  if (!take_field(fields).empty()) throw std::invalid_argument("too many fields");
}

void set_sick_angles(CarmenScan& scan) {
  const auto beams = static_cast<double>(scan.ranges_m.size());
  scan.start_angle_rad = -90 * kDegree;
  if (beams == 180 || beams == 181) {
    scan.beam_step_rad = kDegree;
  } else if (beams == 360 || beams == 361) {
    scan.beam_step_rad = 0.5 * kDegree;
  } else if (beams == 400 || beams == 401) {
    scan.start_angle_rad = -50 * kDegree;
    scan.beam_step_rad = 0.25 * kDegree;
  } else if (beams > 1) {
    scan.beam_step_rad = 180 * kDegree / (beams - 1);
  } else {
    scan.start_angle_rad = 0;
    scan.beam_step_rad = kDegree;
  }
}

}  // namespace

CarmenScan parse_flaser(std::string_view fields) {
  CarmenScan scan;
  scan.ranges_m = take_numbers(fields, "range");
  set_sick_angles(scan);
  scan.T_odom_laser = take_pose(fields, "laser pose");
  scan.T_odom_robot = take_pose(fields, "robot pose");
  take_stamp(scan, fields);
  return scan;
}

CarmenScan parse_robotlaser(std::string_view fields) {
  CarmenScan scan;
  take_number(fields, "laser type");
  scan.start_angle_rad = take_below(fields, "start angle", kLargestAngle);
  const double field_of_view_rad = take_below(fields, "field of view", kLargestAngle);
  scan.beam_step_rad = take_below(fields, "angular resolution", kLargestAngle);
  scan.max_range_m = std::max(0.0, take_below(fields, "maximum range", kFarthestRange));
  take_number(fields, "accuracy");
  take_number(fields, "remission mode");
  scan.ranges_m = take_numbers(fields, "range");
  take_numbers(fields, "remission");
  scan.T_odom_laser = take_pose(fields, "laser pose");
  scan.T_odom_robot = take_pose(fields, "robot pose");
  for (const char* name : {"tv", "rv", "forward_safety_dist", "side_safety_dist", "turn_axis"})
    take_number(fields, name);
  take_stamp(scan, fields);
  if (scan.beam_step_rad == 0 && scan.ranges_m.size() > 1)
    scan.beam_step_rad = field_of_view_rad / (static_cast<double>(scan.ranges_m.size()) - 1);
  return scan;
}

std::optional<double> parse_max_range_param(std::string_view fields) {
  const std::string_view name = take_field(fields);
  if (name != "robot_front_laser_max" && name != "robot_frontlaser_max") return std::nullopt;
  const auto value = to_number(take_field(fields));
  return value && *value > 0 && *value <= kFarthestRange ? value : std::nullopt;
}

}  // namespace hmt::submap
