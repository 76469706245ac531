// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "common_share.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace hmt::submap {

void check(const OverlapOptions& options) {
  if (!(options.max_mahalanobis > 0) || !std::isfinite(options.max_mahalanobis)) {
    throw InputError("overlap: max_mahalanobis is " + std::to_string(options.max_mahalanobis) +
                     ", must be positive and finite");
  }
  if (!(options.max_pose_deviation_m > 0) || !std::isfinite(options.max_pose_deviation_m)) {
    throw InputError("overlap: max_pose_deviation_m is " +
                     std::to_string(options.max_pose_deviation_m) +
                     ", must be positive and finite");
  }
  if (!(options.min_overlap >= 0 && options.min_overlap < 1)) {
    throw InputError("overlap: min_overlap is " + std::to_string(options.min_overlap) +
                     ", must be in [0, 1)");
  }
}

void check_finite(const Pose& pose) {
  if (!pose.translation.allFinite() || !pose.rotation.coeffs().allFinite()) {
    throw InputError("overlap: a pose is not finite");
  }
}

double sensed_space_overlap(double size_a, double size_b, const Matches& matches) {
  if (size_a <= 0 || size_b <= 0) return 0;
  // Upper bounds of matches may exceed a size that is no whole number.
  const double common = 0.5 * (std::min(matches.of_a, size_a) + std::min(matches.of_b, size_b));
  return common / (size_a + size_b - common);
}

}  // namespace hmt::submap
