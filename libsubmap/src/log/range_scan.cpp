// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_scan.hpp"

#include <cmath>

namespace hmt::submap {

UsedRanges add_ranges(std::span<const double> ranges_m, double start_angle_rad,
                      double beam_step_rad, Reading& reading) {
  UsedRanges used;
  used.beams_of_points.reserve(ranges_m.size());
  reading.beam_step_rad = std::abs(beam_step_rad);
  for (size_t i = 0; i < ranges_m.size(); ++i) {
    const double range_m = ranges_m[i];
    const double angle_rad = start_angle_rad + static_cast<double>(i) * beam_step_rad;
    const Eigen::Vector3d direction(std::cos(angle_rad), std::sin(angle_rad), 0);
    if (std::isnan(range_m)) {
      ++used.not_a_number;
    } else if (range_m <= 0) {
      ++used.not_positive;
    } else if (range_m >= reading.max_range_m) {
      reading.misses_sensor.push_back(direction.cast<float>());
    } else {
      reading.points_sensor.push_back((range_m * direction).cast<float>());
      used.beams_of_points.push_back(static_cast<uint32_t>(i));
    }
  }
  return used;
}

}  // namespace hmt::submap
