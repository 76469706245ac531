// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/robust_solution.hpp"

#include <numeric>

#include "hmt/graph/pairwise_consistency.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/local/optimize_submap.hpp"

namespace hmt::submap {

Constraint as_constraint(const LoopCandidate& loop) {
  const auto kind =
      loop.verdict == LoopVerdict::confirmed ? ConstraintKind::confirmed : ConstraintKind::loop;
  return {loop.a, loop.b, kind, loop.T_a_b, loop.information};
}

std::vector<LoopCandidate> consistent_loops(std::vector<LoopCandidate> candidates,
                                            const graph::PoseGraph& trajectory) {
  std::vector<size_t> accepted;
  std::vector<graph::PoseGraphEdge> edges;
  for (size_t k = 0; k < candidates.size(); ++k) {
    LoopCandidate& loop = candidates[k];
    if (loop.verdict != LoopVerdict::accepted) continue;
    if (!is_firm(as_constraint(loop), trajectory.space)) {
      loop.verdict = LoopVerdict::unconfirmed;
      loop.reason = "the registration leaves a direction free";
      continue;
    }
    accepted.push_back(k);
    edges.push_back({loop.a, loop.b, loop.T_a_b, loop.information});
  }
  const std::vector<bool> consistent = graph::pairwise_consistent_set(trajectory, edges);
  for (size_t k = 0; k < accepted.size(); ++k) {
    if (consistent[k]) continue;
    candidates[accepted[k]].verdict = LoopVerdict::inconsistent;
    candidates[accepted[k]].reason =
        "disagrees with the largest set of loop closures that agree with each other";
  }
  return candidates;
}

RobustSolution solve_robustly(Space space, std::span<const Pose> T_world_keyframe,
                              std::span<const Constraint> constraints,
                              std::span<const Sighting> sightings, const Run& run) {
  std::vector<int> all(T_world_keyframe.size());
  std::iota(all.begin(), all.end(), 0);
  graph::PoseGraph graph = keyframe_graph(space, all, T_world_keyframe, constraints, sightings);
  if (!graph.poses.empty()) graph.fixed = {0};
  graph::PoseOptimizerOptions options;
  options.robust = graph::RobustMethod::gnc;
  options.threads = run.threads;
  for (const Constraint& c : constraints) options.trusted.push_back(is_trusted(c));
  const graph::PoseOptimizerResult result = graph::optimize(graph, options);
  RobustSolution solution;
  solution.T_world_keyframe = result.poses;
  solution.chi2 = result.report.chi2;
  for (size_t k = 0; k < constraints.size(); ++k)
    (result.report.inlier[k] ? solution.kept : solution.outliers).push_back(constraints[k]);
  for (size_t k = 0; k < sightings.size(); ++k)
    if (result.report.point_inlier[k]) solution.kept_sightings.push_back(sightings[k]);
  return solution;
}

}  // namespace hmt::submap
