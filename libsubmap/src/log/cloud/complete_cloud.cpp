// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "complete_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../report_book.hpp"

namespace hmt::submap {

void complete_cloud(Reading& reading) {
  float farthest_m = 0;
  for (const Eigen::Vector3f& p_sensor : reading.points_sensor)
    farthest_m = std::max(farthest_m, p_sensor.norm());
  reading.max_range_m = farthest_m;
  // 4 pi steradians, shared by the points.
  if (!reading.points_sensor.empty())
    reading.beam_step_rad =
        std::sqrt(4 * std::numbers::pi / static_cast<double>(reading.points_sensor.size()));
}

void note_cloud(LogReport& report, const CloudPoints& cloud, const std::string& place) {
  if (cloud.points.empty()) add_note(report, "clouds without points", place);
  add_note(report, "points left out: not finite", place, cloud.not_finite);
  add_note(report, "points left out: at the sensor itself", place, cloud.at_origin);
}

}  // namespace hmt::submap
