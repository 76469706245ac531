// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "seen_through.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "registration_target.hpp"

namespace hmt::submap {
namespace {

// Beams of a degree: no common laser has wider gaps.
constexpr int kBearings = 360;
constexpr double kBearing_rad = 2 * std::numbers::pi / kBearings;
// Nearer than this to what was measured, a surface may be the one that was measured.
constexpr double kMargin_m = 0.3;
// Within reach of the sensor's own mount and of rounding of the bearing.
constexpr double kLeastRange_m = 0.5;

size_t bearing(double x, double y) {
  const double turn = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
  return static_cast<size_t>(std::clamp(static_cast<int>(turn * kBearings), 0, kBearings - 1));
}

/// Least range that a surface measured in each bearing from its origin; 0 where it measured none.
struct View {
  explicit View(const Surface& surface) {
    for (const Eigen::Vector3d& p : surface.points_robot) {
      const double range = std::hypot(p.x(), p.y());
      double& least = ranges[bearing(p.x(), p.y())];
      if (least == 0 || range < least) least = range;
    }
    farthest = *std::max_element(ranges.begin(), ranges.end());
  }

  std::array<double, kBearings> ranges{};
  double farthest = 0;
};

enum class Sight { hidden, met, passed };

/// How a piece of surface lies in a view, in whose frame it is given.
Sight sight(const View& view, const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
  // The back of a surface is not in view, nor is what lies behind something.
  const double before_m = -normal.dot(p);
  if (before_m <= 0) return Sight::hidden;
  const double range = p.head<2>().norm();
  if (range < kLeastRange_m || range > view.farthest + kMargin_m) return Sight::hidden;
  const double measured = view.ranges[bearing(p.x(), p.y())];
  if (measured == 0 || range > measured + kMargin_m) return Sight::hidden;
  // A beam that grazes a surface has not passed through it: it must have ended well behind it, also
  // if its bearing is off by that of the next one.
  const double behind_m = before_m * (measured / range - 1);
  return behind_m > kMargin_m + kBearing_rad * range ? Sight::passed : Sight::met;
}

}  // namespace

double seen_through_share(const Surface& source, const RegistrationTarget& target,
                          const Pose& T_target_source) {
  const View view(source);
  const Pose T_source_target = T_target_source.inverse();
  const Eigen::Matrix3d R_source_target = T_source_target.rotation_matrix();
  int passed = 0;
  int met = 0;
  for (const SurfaceElement& element : target.impl().elements) {
    const Sight seen = sight(view, R_source_target * element.point + T_source_target.translation,
                             R_source_target * element.normal);
    passed += seen == Sight::passed;
    met += seen == Sight::met;
  }
  return passed + met == 0 ? 0.0 : passed / static_cast<double>(passed + met);
}

double standing_in_view_share(const Surface& source,
                              std::span<const RegistrationTarget::Placed> target,
                              const Pose& T_target_source) {
  std::vector<char> stands(source.size(), 0);
  for (const RegistrationTarget::Placed& placed : target) {
    const View view(*placed.surface);
    const Pose T_placed_source = relative_pose(placed.T_target_robot, T_target_source);
    const Eigen::Matrix3d R = T_placed_source.rotation_matrix();
    for (size_t i = 0; i < source.size(); ++i)
      stands[i] |= sight(view, R * source.points_robot[i] + T_placed_source.translation,
                         R * source.normals_robot[i]) == Sight::passed;
  }
  const auto standing = std::count(stands.begin(), stands.end(), 1);
  const auto usable = std::count_if(source.normals_robot.begin(), source.normals_robot.end(),
                                    [](const Eigen::Vector3d& n) { return !n.isZero(0); });
  return usable == 0 ? 0.0 : static_cast<double>(standing) / static_cast<double>(usable);
}

}  // namespace hmt::submap
