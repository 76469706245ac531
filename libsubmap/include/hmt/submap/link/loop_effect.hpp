// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/graph/pose_graph.hpp"
#include "hmt/submap/link/loop_search.hpp"
#include "hmt/submap/registration/constraint.hpp"

namespace hmt::submap {

/// Fills in `chi2_rise` of every candidate that has a match, at the poses of `solved`, which must
/// be the least-squares optimum of `constraints`: with r the residual of the candidate, I its
/// information, L L^T = I, and P the covariance of T_a_b in the graph,
///   r^T L (1 + L^T P L)^-1 L^T r   where the candidate is not among the constraints,
///   r^T L (1 - L^T P L)^-1 L^T r   where it is,
/// exact for linear residuals. A direction that nothing but the candidate fixes raises nothing.
/// Accepted candidates that are not among the constraints become outliers.
void rate_effects(std::vector<LoopCandidate>& candidates, const graph::PoseGraph& solved,
                  std::span<const Constraint> constraints, int threads);

/// True if two candidates tell the same of one revisit: their ends lie within 16 m of travel of
/// each other, and by the poses the second puts the first's keyframes where the first does, to a
/// metre and 0.2 rad.
/// `path_m`: distance travelled up to each keyframe.
bool tells_the_same(const LoopCandidate& left, const LoopCandidate& right,
                    std::span<const Pose> T_world_keyframe, std::span<const double> path_m);

/// The judgements of a new search join those of earlier ones. Of a pair that is there already the
/// new judgement replaces the earlier one at its place, unless that one is a closure or the user's;
/// the others are appended. So the place of a candidate, its id, never changes.
std::vector<LoopCandidate> join_candidates(std::vector<LoopCandidate> earlier,
                                           std::vector<LoopCandidate> found);

}  // namespace hmt::submap
