// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/graph/pose_graph.hpp"
#include "hmt/submap/link/loop_search.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/sighting.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// The constraint that a loop closure is worth.
Constraint as_constraint(const LoopCandidate& loop);

/// Judges the accepted candidates together: those that are not firm become `unconfirmed`, those
/// outside the largest pairwise consistent set [Mangelson 2018] become `inconsistent`. `trajectory`
/// holds the keyframes and the constraints that are not in doubt. Verdicts other than `accepted`
/// stay as they are.
std::vector<LoopCandidate> consistent_loops(std::vector<LoopCandidate> candidates,
                                            const graph::PoseGraph& trajectory);

/// Poses of the keyframes by all constraints; those between different visits to a place are
/// doubted.
struct RobustSolution {
  std::vector<Pose> T_world_keyframe;
  std::vector<Constraint> kept;      ///< the constraints without the outliers, in their order
  std::vector<Constraint> outliers;  ///< refused by graduated non-convexity
  std::vector<Sighting> kept_sightings;
  double chi2 = 0;  ///< of the kept ones
};

/// Optimizes all keyframes with graduated non-convexity [Yang 2020]: odometry and registrations
/// within one visit are trusted, and so is what the user confirmed; all other constraints and
/// sightings are in or out.
RobustSolution solve_robustly(Space space, std::span<const Pose> T_world_keyframe,
                              std::span<const Constraint> constraints,
                              std::span<const Sighting> sightings, const Run& run);

}  // namespace hmt::submap
