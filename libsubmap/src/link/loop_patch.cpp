// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_patch.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

/// A robot that turns on the spot makes keyframes without travelling: enough of them is enough.
constexpr int kMostToEachSide = 30;
constexpr double kPatchCellM = 0.1;
/// Points this close in front of what was seen are not contradicted: noise, drift within the patch
/// and door leaves.
constexpr double kSightMarginM = 0.4;
/// One more looker must agree: a single wrong beam is no proof of free space.
constexpr int kLeastLookers = 2;

Eigen::Vector2d planar(const Pose& T, const Eigen::Vector2d& p) {
  return (T * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>();
}

}  // namespace

LevelPose level_pose(Space space, const Pose& T_world_robot) {
  if (space == Space::se2) return {T_world_robot, Pose{}};
  const Eigen::Vector3d& t = T_world_robot.translation;
  const Pose T_world_level = Pose::planar(t.x(), t.y(), T_world_robot.yaw_rad());
  return {T_world_level, graph::relative_pose(T_world_level, T_world_robot)};
}

std::vector<double> path_lengths(std::span<const Pose> T_world_keyframe) {
  std::vector<double> path_m(T_world_keyframe.size(), 0.0);
  for (size_t k = 1; k < path_m.size(); ++k)
    path_m[k] = path_m[k - 1] +
                (T_world_keyframe[k].translation - T_world_keyframe[k - 1].translation).norm();
  return path_m;
}

std::pair<int, int> patch_range(std::span<const double> path_m, int center, double reach_m) {
  const auto at = [&](int k) { return path_m[static_cast<size_t>(k)]; };
  const int last_keyframe = static_cast<int>(path_m.size()) - 1;
  int first = center;
  int last = center;
  while (first > 0 && center - first < kMostToEachSide && at(center) - at(first - 1) <= reach_m)
    --first;
  while (last < last_keyframe && last - center < kMostToEachSide &&
         at(last + 1) - at(center) <= reach_m)
    ++last;
  return {first, last};
}

LoopPatch make_patch(const LoopProblem& problem, std::span<const double> path_m,
                     std::span<const PlanarScan> scans, int center, double reach_m) {
  LoopPatch patch;
  patch.center = center;
  const auto [first, last] = patch_range(path_m, center, reach_m);
  const auto level = [&](int k) {
    return level_pose(problem.space, problem.T_world_keyframe[static_cast<size_t>(k)]);
  };
  const LevelPose center_level = level(center);
  patch.T_level_center = center_level.T_level_robot;
  std::vector<Eigen::Vector2f> points;
  for (int k = first; k <= last; ++k) {
    patch.keyframes.push_back(k);
    const Pose T = graph::relative_pose(problem.T_world_keyframe[static_cast<size_t>(center)],
                                        problem.T_world_keyframe[static_cast<size_t>(k)]);
    patch.T_center_keyframe.push_back(T);
    const Pose T_level = graph::relative_pose(center_level.T_world_level, level(k).T_world_level);
    for (const Eigen::Vector2f& p : scans[static_cast<size_t>(k)].points_robot)
      points.push_back(planar(T_level, p.cast<double>()).cast<float>());
  }
  patch.points_center = thin_points(points, kPatchCellM);
  return patch;
}

double seen_through_share(const LoopPatch& seer, std::span<const PlanarScan> scans,
                          const LoopPatch& seen, const Pose& T_seer_seen) {
  std::vector<Pose> T_keyframe_seen;
  for (const Pose& T_center_keyframe : seer.T_center_keyframe)
    T_keyframe_seen.push_back(T_center_keyframe.inverse() * T_seer_seen);
  int conflicts = 0;
  for (const Eigen::Vector2f& p : seen.points_center) {
    int lookers = 0;
    for (size_t i = 0; i < seer.keyframes.size() && lookers < kLeastLookers; ++i) {
      const PlanarScan& scan = scans[static_cast<size_t>(seer.keyframes[i])];
      if (sees_through(scan, planar(T_keyframe_seen[i], p.cast<double>()), kSightMarginM))
        ++lookers;
    }
    if (lookers >= kLeastLookers) ++conflicts;
  }
  return seen.points_center.empty() ? 0.0
                                    : conflicts / static_cast<double>(seen.points_center.size());
}

}  // namespace hmt::submap
