// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "seen_through.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "registration_target.hpp"

namespace hmt::submap {
namespace {

// Beams of a degree: no common laser has wider gaps.
constexpr int kBearings = 360;
// Nearer than this to what was measured, a surface may be the one that was measured.
constexpr double kMargin_m = 0.3;
// Within reach of the sensor's own mount and of rounding of the bearing.
constexpr double kLeastRange_m = 0.5;

size_t bearing(double x, double y) {
  const double turn = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
  return static_cast<size_t>(std::clamp(static_cast<int>(turn * kBearings), 0, kBearings - 1));
}

/// Least range that the source measured in each bearing from its origin; 0 where it measured none.
std::array<double, kBearings> measured_ranges(const Surface& source) {
  std::array<double, kBearings> ranges{};
  for (const Eigen::Vector3d& p : source.points_robot) {
    const double range = std::hypot(p.x(), p.y());
    double& least = ranges[bearing(p.x(), p.y())];
    if (least == 0 || range < least) least = range;
  }
  return ranges;
}

}  // namespace

double seen_through_share(const Surface& source, const RegistrationTarget& target,
                          const Pose& T_target_source) {
  const std::array<double, kBearings> ranges = measured_ranges(source);
  const double farthest = *std::max_element(ranges.begin(), ranges.end());
  const Pose T_source_target = T_target_source.inverse();
  const Eigen::Matrix3d R_source_target = T_source_target.rotation_matrix();
  int through = 0;
  int met = 0;
  for (const SurfaceElement& element : target.impl().elements) {
    const Eigen::Vector3d p = R_source_target * element.point + T_source_target.translation;
    // The back of a surface is not in view, nor is what lies behind something.
    const double before_m = -(R_source_target * element.normal).dot(p);
    if (before_m <= 0) continue;
    const double range = p.head<2>().norm();
    if (range < kLeastRange_m || range > farthest + kMargin_m) continue;
    const double measured = ranges[bearing(p.x(), p.y())];
    if (measured == 0 || range > measured + kMargin_m) continue;
    // A beam that grazes a surface has not passed through it: it must have ended well behind it.
    const double behind_m = before_m * (measured / range - 1);
    ++(behind_m > kMargin_m ? through : met);
  }
  return through + met == 0 ? 0.0 : through / static_cast<double>(through + met);
}

}  // namespace hmt::submap
