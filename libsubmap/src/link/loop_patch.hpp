// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "loop_scans.hpp"

namespace hmt::submap {

/// What was seen farther from the center of a query than this is not asked for: the map need not
/// reach so far, and every error of the heading counts there.
inline constexpr double kQueryRangeM = 15.0;
/// The same of clouds, which see farther and know their heading better.
inline constexpr double kCloudQueryRangeM = 30.0;
inline double query_range_m(Space space) {
  return space == Space::se2 ? kQueryRangeM : kCloudQueryRangeM;
}

/// A pose as its place seen from above and the rest: T_world_robot = T_world_level T_level_robot,
/// the first a planar pose, the second height and tilt. In Space::se2 all of it is place.
struct LevelPose {
  Pose T_world_level;
  Pose T_level_robot;
};
LevelPose level_pose(Space space, const Pose& T_world_robot);

/// Distance travelled up to each keyframe, metres.
std::vector<double> path_lengths(std::span<const Pose> T_world_keyframe);

/// A stretch of the track around one keyframe, short enough to be rigid, with all that was seen
/// from it.
struct LoopPatch {
  int center = 0;
  std::vector<int> keyframes;                  ///< ascending
  std::vector<Pose> T_center_keyframe;         ///< one each
  Pose T_level_center;                         ///< height and tilt of the center
  std::vector<Eigen::Vector2f> points_center;  ///< thinned, in the level frame of the center
};

/// First and last keyframe of the stretch that lies within `reach_m` of travel around `center`.
std::pair<int, int> patch_range(std::span<const double> path_m, int center, double reach_m);

LoopPatch make_patch(const LoopProblem& problem, std::span<const double> path_m,
                     std::span<const PlanarScan> scans, int center, double reach_m);

/// Share of the points of `seen` that lie where `seer` looked through, when the frame of `seen`
/// stands at T_seer_seen (centers).
double seen_through_share(const LoopPatch& seer, std::span<const PlanarScan> scans,
                          const LoopPatch& seen, const Pose& T_seer_seen);

}  // namespace hmt::submap
