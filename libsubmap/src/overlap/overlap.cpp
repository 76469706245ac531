// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/overlap/overlap.hpp"

#include <algorithm>

#include "common_share.hpp"
#include "count_matches.hpp"
#include "sensed_points.hpp"

namespace hmt::submap {

double reading_overlap(const Reading& a, const Reading& b, const Pose& T_robota_robotb,
                       const Matrix6d& covariance_a_b, const OverlapOptions& options) {
  check(options);
  check_finite(T_robota_robotb);
  const SensedPoints points_a(a, Pose{}, options.max_mahalanobis);
  const SensedPoints points_b(b, T_robota_robotb, options.max_mahalanobis);
  const PoseSpread spread(T_robota_robotb, covariance_a_b);
  return sensed_space_overlap(points_a.size(), points_b.size(),
                              count_matches(points_a, points_b, spread, options),
                              count_matches(points_b, points_a, spread, options));
}

double observation_overlap(const Observation& a, const Observation& b, const Pose& T_robota_robotb,
                           const Matrix6d& covariance_a_b, const OverlapOptions& options) {
  check(options);
  double sum = 0;
  int sensors = 0;
  for (const Reading& reading_a : a.readings) {
    const auto reading_b =
        std::find_if(b.readings.begin(), b.readings.end(),
                     [&](const Reading& r) { return r.sensor == reading_a.sensor; });
    if (reading_b == b.readings.end()) continue;
    sum += reading_overlap(reading_a, *reading_b, T_robota_robotb, covariance_a_b, options);
    ++sensors;
  }
  return sensors > 0 ? sum / sensors : 0.0;
}

}  // namespace hmt::submap
