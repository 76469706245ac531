// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hmt::submap {

/// The points of a cloud that can be used, in the sensor frame in metres, and what was left out.
struct CloudPoints {
  std::vector<Eigen::Vector3f> points;
  /// When each of them was seen, as the log tells it, whatever the unit; empty if it does not.
  std::vector<double> times;
  bool times_in_nanoseconds = false;  ///< surely, as of whole numbers
  int64_t not_finite = 0;             ///< nowhere: NaN, infinite or beyond 100 km
  int64_t at_origin = 0;              ///< exactly (0, 0, 0): how drivers say "no return"
  /// Why points are missing; empty where none is.
  std::string damage;

  /// Adds it if it can be used, and says whether it did.
  bool add(const Eigen::Vector3f& p_sensor);
};

/// Infinite beyond what is used at all: a double may not fit a float.
float to_float(double coordinate);

/// Where a coordinate begins and how it is stored.
struct Coordinate {
  size_t offset = 0;
  bool is_double = false;

  size_t size() const { return is_double ? sizeof(double) : sizeof(float); }
  float load(const char* point, bool little_endian) const;
};

/// Where the time of a point begins and how it is stored.
struct PointTime {
  size_t offset = 0;
  size_t size = 0;  ///< 4 or 8 bytes
  bool is_float = false;

  double load(const char* point, bool little_endian) const;
};

/// How the points of a cloud lie in memory: one after the other, each of `step` bytes.
struct PointLayout {
  std::array<std::optional<Coordinate>, 3> xyz;
  std::optional<PointTime> time;
  size_t step = 0;
  bool little_endian = true;

  /// Takes a field if it is called x, y or z, or like the time of a point; `is_float` tells a float
  /// or a double by its size. False for a coordinate that is neither.
  bool add_field(std::string_view name, size_t offset, size_t size, bool is_float);
  /// What is wrong with it; empty where nothing is.
  std::string problem() const;
};

/// Adds the first `count` points of `data`, whose layout has no problem; fewer if it ends early.
void add_points(std::string_view data, uint64_t count, const PointLayout& layout,
                CloudPoints& cloud);

}  // namespace hmt::submap
