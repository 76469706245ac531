// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// What became of the ranges of a scan.
struct UsedRanges {
  // Neither a point nor a miss.
  int64_t not_a_number = 0;
  int64_t not_positive = 0;
  std::vector<uint32_t> beams_of_points;  ///< the number of the beam of each point
};

/// Turns the ranges of a planar scanner, beam i at start_angle_rad + i * beam_step_rad, into the
/// points and misses of `reading`, whose max_range_m is set already: at or beyond it lies a miss.
UsedRanges add_ranges(std::span<const double> ranges_m, double start_angle_rad,
                      double beam_step_rad, Reading& reading);

}  // namespace hmt::submap
