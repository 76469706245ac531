// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// Ranges that are neither a point nor a miss.
struct DroppedRanges {
  int64_t not_a_number = 0;
  int64_t not_positive = 0;
};

/// Turns the ranges of a planar scanner, beam i at start_angle_rad + i * beam_step_rad, into the
/// points and misses of `reading`, whose max_range_m is set already: at or beyond it lies a miss.
DroppedRanges add_ranges(std::span<const double> ranges_m, double start_angle_rad,
                         double beam_step_rad, Reading& reading);

}  // namespace hmt::submap
