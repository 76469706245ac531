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

/// All that an observation holds but index, stamp and pose, exactly, as one zstd frame. Inside,
/// little endian:
///   u32 readings, then for each: i32 sensor; f64 x y z qx qy qz qw of T_robot_sensor;
///   f64 max_range_m, beam_step_rad; u32 points, u32 misses; then points and misses as bytes in
///   planes (all lowest bytes of x, then the next ones, ... then y, z), which compresses best;
///   u32 readings of landmarks, then for each: i32 sensor; f64 x y z qx qy qz qw of T_robot_sensor;
///   u32 landmarks, then for each: i64 id; f64 x y z; 9 f64 of the covariance; u32 size and f32 of
///   the descriptor;
///   u8 1 and 36 f64 of the covariance of the motion, or u8 0.
std::string encode_sensed(const Observation& observation);
/// The inverse; false where the bytes are damaged.
bool decode_sensed(std::string_view frame, Observation& observation);

}  // namespace hmt::submap
