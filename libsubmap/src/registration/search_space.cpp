// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "search_space.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "registration_target.hpp"
#include "surface_matches.hpp"

namespace hmt::submap {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
// Points and map elements that are enough to tell poses some decimetres apart.
constexpr size_t kPoints = 600;
constexpr double kCell_m = 0.4;
// From farther away no point finds its surface.
constexpr double kReach_m = 2.0;
constexpr int kIterations = 15;
// Turns and tilts of a guess: registration bridges half of the way from one to the next.
constexpr std::array kTurns{0.0, 15.0, -15.0, 30.0, -30.0, 45.0, -45.0};
constexpr std::array kTilts{10.0, -10.0};

// A point meets the map within so many standard deviations, or this far.
constexpr double kMeets = 3;
constexpr double kMeets_m = 0.05;
constexpr double kMeetReach_m = 1.0;
// Directions of which a cloud shows less than this share count the less.
constexpr double kLeastShare = 0.05;

constexpr size_t kMatches = 3;
constexpr double kDistinct_m = 0.3;
constexpr double kDistinct_rad = 0.1;

void append(Surface& to, const Surface& from, size_t i) {
  to.points_robot.push_back(from.points_robot[i]);
  to.normals_robot.push_back(from.normals_robot[i]);
  to.sigma_m.push_back(from.sigma_m[i]);
  to.normal_sigma_rad.push_back(from.normal_sigma_rad[i]);
  to.spacing_m.push_back(from.spacing_m[i]);
}

Surface every_nth(const Surface& surface) {
  std::vector<size_t> usable;
  for (size_t i = 0; i < surface.size(); ++i)
    if (!surface.normals_robot[i].isZero(0)) usable.push_back(i);
  const size_t stride = std::max<size_t>(1, (usable.size() + kPoints - 1) / kPoints);
  Surface part;
  for (size_t k = 0; k < usable.size(); k += stride) append(part, surface, usable[k]);
  return part;
}

RegistrationTarget coarse(const RegistrationTarget& map) {
  Surface all;
  for (const SurfaceElement& element : map.impl().elements) {
    all.points_robot.push_back(element.point);
    all.normals_robot.push_back(element.normal);
    all.sigma_m.push_back(std::sqrt(element.variance));
    all.normal_sigma_rad.push_back(std::sqrt(element.normal_variance));
    all.spacing_m.push_back(element.spacing_m);
  }
  const RegistrationTarget::Placed placed{Pose{}, &all};
  return RegistrationTarget(std::span(&placed, 1), kCell_m);
}

Pose turned(const Pose& T, const Eigen::Vector3d& axis, double degrees) {
  return {T.translation, T.rotation * Eigen::AngleAxisd(degrees * kDegree, axis)};
}

std::vector<Pose> starts_around(const Pose& guess) {
  std::vector<Pose> starts;
  for (const double turn : kTurns) starts.push_back(turned(guess, Eigen::Vector3d::UnitZ(), turn));
  for (const double tilt : kTilts) {
    starts.push_back(turned(guess, Eigen::Vector3d::UnitX(), tilt));
    starts.push_back(turned(guess, Eigen::Vector3d::UnitY(), tilt));
  }
  return starts;
}

bool is_distinct(const Pose& a, const Pose& b) {
  const Vector6d difference = graph::boxminus(a, b);
  return difference.head<3>().norm() > kDistinct_m || difference.tail<3>().norm() > kDistinct_rad;
}

}  // namespace

double met_share(const Surface& source, const RegistrationTarget& map, const Pose& T_map_robot) {
  RegistrationOptions options;
  options.max_correspondence_m = kMeetReach_m;
  SurfaceMatcher matcher(source, map.impl(), options);
  matcher.match(T_map_robot);
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero(), met = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& normal : source.normals_robot) all += normal * normal.transpose();
  for (const Match& match : matcher.matches()) {
    const Eigen::Vector3d& normal = source.normals_robot[match.source];
    if (std::abs(match.residual_m) <= std::max(kMeets_m, kMeets * std::sqrt(match.variance())))
      met += normal * normal.transpose();
  }
  if (all.trace() <= 0) return 0;
  all += kLeastShare * all.trace() * Eigen::Matrix3d::Identity();
  return (all.inverse() * met).trace() / 3;
}

std::vector<SpaceMatch> search_space(const Surface& source, const RegistrationTarget& map,
                                     std::span<const Pose> T_map_robot_guesses) {
  const Surface part = every_nth(source);
  const RegistrationTarget coarse_map = coarse(map);
  RegistrationOptions options;
  options.space = Space::se3;
  options.max_correspondence_m = kReach_m;
  options.is_guess_vague = true;
  options.max_iterations = kIterations;
  std::vector<SpaceMatch> found;
  for (const Pose& guess : T_map_robot_guesses)
    for (const Pose& start : starts_around(guess)) {
      const Pose T = register_surface(part, coarse_map, start, options).T_target_source;
      found.push_back({T, met_share(part, map, T)});
    }
  std::stable_sort(found.begin(), found.end(), [](const SpaceMatch& a, const SpaceMatch& b) {
    return a.met_share > b.met_share;
  });
  std::vector<SpaceMatch> best;
  for (const SpaceMatch& match : found) {
    if (best.size() == kMatches) break;
    if (std::all_of(best.begin(), best.end(), [&](const SpaceMatch& other) {
          return is_distinct(match.T_map_robot, other.T_map_robot);
        }))
      best.push_back(match);
  }
  return best;
}

}  // namespace hmt::submap
