// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/map_quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <unordered_set>

#include "hmt/submap/export/evaluation.hpp"
#include "hmt/submap/registration/surface.hpp"

namespace hmt::submap {
namespace {

constexpr double kCell_m = 0.05;
constexpr double kPatch_m = 0.3;
constexpr int kLeastPoints = 8;
/// Directions that walls face, in the plane; what faces up or down has two more.
constexpr int kFacings = 8;

/// Cell of a point on a grid, 20 bits a coordinate, and room for a direction.
uint64_t cell_key(const Eigen::Vector3d& p, double cell_m) {
  const auto part = [cell_m](double v) {
    const double cell = std::clamp(std::floor(v / cell_m), -524288.0, 524287.0);
    return static_cast<uint64_t>(static_cast<int64_t>(cell) + 524288);
  };
  return (part(p.x()) << 40) | (part(p.y()) << 20) | part(p.z());
}

uint64_t facing(const Eigen::Vector3d& normal) {
  if (std::abs(normal.z()) > std::numbers::sqrt2 / 2) return kFacings + (normal.z() > 0 ? 1 : 0);
  const double turns = std::atan2(normal.y(), normal.x()) / (2 * std::numbers::pi);
  const long bin = std::lround(turns * kFacings);
  return static_cast<uint64_t>((bin + kFacings) % kFacings);
}

/// Sums over the points of a patch, relative to its first point.
struct Patch {
  int points = 0;
  int scans = 0;
  int64_t last_scan = -1;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();

  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, int64_t scan) {
    if (points++ == 0) first = p;
    if (scan != last_scan) ++scans;
    last_scan = scan;
    const Eigen::Vector3d d = p - first;
    sum += d;
    squares += d * d.transpose();
    normal += n;
  }
  double thickness_m() const {
    const Eigen::Vector3d n = normal.normalized();
    const Eigen::Vector3d mean = sum / points;
    const Eigen::Matrix3d covariance = squares / points - mean * mean.transpose();
    return 2 * std::sqrt(std::max(0.0, n.dot(covariance * n)));
  }
};

}  // namespace

std::vector<PosedObservation> observations_along(const Track& track,
                                                 std::span<const StampedPose> trajectory) {
  std::vector<std::pair<double, int64_t>> by_stamp;
  for (const TrackedObservation& tracked : track.observations)
    by_stamp.emplace_back(tracked.stamp_s, tracked.observation);
  std::sort(by_stamp.begin(), by_stamp.end());
  std::map<int64_t, Pose> posed;
  for (const StampedPose& pose : trajectory) {
    auto at =
        std::lower_bound(by_stamp.begin(), by_stamp.end(), std::pair(pose.stamp_s, int64_t{-1}));
    if (at == by_stamp.end() ||
        (at != by_stamp.begin() && pose.stamp_s - (at - 1)->first < at->first - pose.stamp_s))
      --at;
    if (std::abs(at->first - pose.stamp_s) <= kMaxStampDifference)
      posed.emplace(at->second, pose.T_world_robot);
  }
  std::vector<PosedObservation> result;
  for (const auto& [observation, T_world_robot] : posed)
    result.push_back({observation, T_world_robot});
  return result;
}

MapQuality map_quality(const ObservationStore& store, std::span<const PosedObservation> posed) {
  MapQuality quality;
  std::unordered_set<uint64_t> occupied;
  std::map<std::array<uint64_t, 2>, Patch> patches;  // by cell and facing; summed in this order
  for (const PosedObservation& at : posed) {
    const Surface surface = make_surface(*store.load(at.observation));
    ++quality.scans;
    quality.beams += static_cast<int64_t>(surface.size());
    for (size_t i = 0; i < surface.size(); ++i) {
      const Eigen::Vector3d p = at.T_world_robot * surface.points_robot[i];
      occupied.insert(cell_key(p, kCell_m));
      if (surface.normals_robot[i].isZero(0)) continue;
      const Eigen::Vector3d n = at.T_world_robot.rotation * surface.normals_robot[i];
      patches[{cell_key(p, kPatch_m), facing(n)}].add(p, n, at.observation);
    }
  }
  quality.occupied_cells = static_cast<int64_t>(occupied.size());
  if (quality.beams > 0)
    quality.cells_per_1000_beams =
        1000 * static_cast<double>(quality.occupied_cells) / static_cast<double>(quality.beams);
  double sum_m = 0;
  for (const auto& [key, patch] : patches) {
    if (patch.points < kLeastPoints || patch.scans < 2) continue;
    sum_m += patch.thickness_m();
    ++quality.wall_patches;
  }
  if (quality.wall_patches > 0)
    quality.mean_wall_thickness_m = sum_m / static_cast<double>(quality.wall_patches);
  return quality;
}

}  // namespace hmt::submap
