// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// Bytes as one zstd frame. Throws std::bad_alloc where there is no memory for it.
std::string compress(std::string_view bytes);
/// The inverse; nothing where the frame is damaged or claims more than `max_bytes`.
std::optional<std::string> decompress(std::string_view frame, size_t max_bytes);

/// The readings of an observation, exactly, as one zstd frame. Inside, little endian:
///   u32 readings, then for each: i32 sensor; f64 x y z qx qy qz qw of T_robot_sensor;
///   f64 max_range_m, beam_step_rad; u32 points, u32 misses; then points and misses as bytes in
///   planes (all lowest bytes of x, then the next ones, ... then y, z), which compresses best.
std::string encode_readings(const std::vector<Reading>& readings);
/// The inverse; nothing where the bytes are damaged.
std::optional<std::vector<Reading>> decode_readings(std::string_view frame);

}  // namespace hmt::submap
