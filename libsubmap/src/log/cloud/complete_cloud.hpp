// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "hmt/submap/log/log_reader.hpp"
#include "point_layout.hpp"

namespace hmt::submap {

/// Sets what a cloud does not tell of itself from its points: max_range_m is the distance of the
/// farthest, beam_step_rad the angle between neighbours if as many lay evenly around the sensor.
void complete_cloud(Reading& reading);

/// Counts the points that were left out of a cloud, and that it has none.
void note_cloud(LogReport& report, const CloudPoints& cloud, const std::string& place);

}  // namespace hmt::submap
