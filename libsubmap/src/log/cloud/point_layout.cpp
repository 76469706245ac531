// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "point_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../ros/wire.hpp"

namespace hmt::submap {
namespace {

/// No sensor sees so far; larger numbers break what is computed from them.
constexpr float kMaxCoordinate = 1e5F;  // metres
/// What drivers call the time of a point: Velodyne's, Ouster's, Hesai's and Robosense's, Livox's.
constexpr std::string_view kTimeNames[] = {"time", "t", "timestamp", "time_stamp", "offset_time"};

}  // namespace

bool CloudPoints::add(const Eigen::Vector3f& p_sensor) {
  // False for NaN, too.
  if (!(p_sensor.array().abs() <= kMaxCoordinate).all()) {
    ++not_finite;
  } else if (p_sensor.isZero(0)) {
    ++at_origin;
  } else {
    points.push_back(p_sensor);
    return true;
  }
  return false;
}

float to_float(double coordinate) {
  return std::abs(coordinate) <= kMaxCoordinate ? static_cast<float>(coordinate)
                                                : std::numeric_limits<float>::infinity();
}

float Coordinate::load(const char* point, bool little_endian) const {
  if (!is_double) return load_number<float>(point + offset, little_endian);
  return to_float(load_number<double>(point + offset, little_endian));
}

double PointTime::load(const char* point, bool little_endian) const {
  const char* at = point + offset;
  if (is_float)
    return size == sizeof(double) ? load_number<double>(at, little_endian)
                                  : double{load_number<float>(at, little_endian)};
  return size == sizeof(uint64_t) ? static_cast<double>(load_number<uint64_t>(at, little_endian))
                                  : static_cast<double>(load_number<uint32_t>(at, little_endian));
}

bool PointLayout::add_field(std::string_view name, size_t offset, size_t size, bool is_float) {
  const bool has_width_of_time = size == sizeof(uint32_t) || size == sizeof(uint64_t);
  if (std::ranges::find(kTimeNames, name) != std::end(kTimeNames) && has_width_of_time)
    time = PointTime{offset, size, is_float};
  if (name.size() != 1 || name[0] < 'x' || name[0] > 'z') return true;
  if (!is_float || (size != sizeof(float) && size != sizeof(double))) return false;
  xyz[static_cast<size_t>(name[0] - 'x')] = Coordinate{offset, size == sizeof(double)};
  return true;
}

std::string PointLayout::problem() const {
  for (const auto& coordinate : xyz) {
    if (!coordinate) return "a field x, y or z is missing";
    if (coordinate->offset + coordinate->size() > step)
      return "a field reaches beyond the end of a point";
  }
  if (time && time->offset + time->size > step) return "a field reaches beyond the end of a point";
  return "";
}

void add_points(std::string_view data, uint64_t count, const PointLayout& layout,
                CloudPoints& cloud) {
  cloud.times_in_nanoseconds = layout.time && !layout.time->is_float;
  const uint64_t points = std::min<uint64_t>(count, data.size() / layout.step);
  for (uint64_t i = 0; i < points; ++i) {
    const char* point = data.data() + i * layout.step;
    const bool is_used = cloud.add({layout.xyz[0]->load(point, layout.little_endian),
                                    layout.xyz[1]->load(point, layout.little_endian),
                                    layout.xyz[2]->load(point, layout.little_endian)});
    if (is_used && layout.time)
      cloud.times.push_back(layout.time->load(point, layout.little_endian));
  }
}

}  // namespace hmt::submap
