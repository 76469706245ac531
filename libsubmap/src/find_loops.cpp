// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "find_loops.hpp"

#include <algorithm>
#include <cmath>

#include "hmt/graph/pose_covariance.hpp"
#include "hmt/submap/link/loop_effect.hpp"
#include "hmt/submap/link/robust_solution.hpp"
#include "link/loop_patch.hpp"
#include "whole_map.hpp"

namespace hmt::submap {
namespace {

// Deviations of a relative pose within which registration finds the right match from the prediction
// alone.
constexpr double kTied_m = 0.1;
constexpr double kTied_rad = 0.03;

/// What the user rejected is not accepted again.
void reject_again(std::vector<LoopCandidate>& candidates, std::span<const LoopCandidate> decided,
                  std::span<const Pose> T_world_keyframe) {
  const std::vector<double> path_m = path_lengths(T_world_keyframe);
  for (LoopCandidate& candidate : candidates)
    for (const LoopCandidate& rejected : decided) {
      if (rejected.verdict != LoopVerdict::rejected || candidate.verdict != LoopVerdict::accepted ||
          !tells_the_same(rejected, candidate, T_world_keyframe, path_m))
        continue;
      candidate.verdict = LoopVerdict::rejected;
      candidate.reason = "tells the same as a candidate that the user rejected";
    }
}

}  // namespace

std::vector<LoopCandidate> find_loops(const LoopSearch& search,
                                      const ObservationStore& observations, const Run& run) {
  const graph::PoseGraph graph =
      graph_of_all(search.track, search.T_world_keyframe, search.constraints, search.sightings);
  const graph::PoseCovariance covariance(graph);
  LoopProblem problem;
  problem.space = search.track.space;
  problem.keyframes = search.track.keyframes;
  problem.T_world_keyframe = search.T_world_keyframe;
  problem.submap = search.submap_of_keyframe;
  problem.first_query = search.first_query;
  problem.query_spacing_m = search.query_spacing_m;
  problem.covariance = [&covariance](int a, int b) { return covariance.relative(a, b); };
  // What is known this well the next round's overlap registers without a search.
  problem.already_tied = [&problem](int a, int b) {
    if (std::abs(a - b) <= kVisitGap) return true;
    const auto known = problem.covariance(a, b);
    return known && known->topLeftCorner<3, 3>().trace() < kTied_m * kTied_m &&
           known->bottomRightCorner<3, 3>().trace() < kTied_rad * kTied_rad;
  };
  problem.observations = &observations;
  std::vector<LoopCandidate> candidates = search_loops(problem, run);
  reject_again(candidates, search.decided, search.T_world_keyframe);
  return consistent_loops(std::move(candidates), graph);
}

bool has_closure(std::span<const LoopCandidate> candidates) {
  return std::any_of(candidates.begin(), candidates.end(),
                     [](const LoopCandidate& c) { return is_closure(c.verdict); });
}

std::vector<Constraint> with_closures(std::vector<Constraint> constraints,
                                      std::span<const LoopCandidate> candidates) {
  for (const LoopCandidate& c : candidates)
    if (is_closure(c.verdict)) constraints.push_back(as_constraint(c));
  return constraints;
}

void mark_outliers(std::vector<LoopCandidate>& candidates, std::span<const Constraint> outliers) {
  for (LoopCandidate& candidate : candidates)
    for (const Constraint& c : outliers)
      if (c.kind == ConstraintKind::loop && c.a == candidate.a && c.b == candidate.b) {
        candidate.verdict = LoopVerdict::outlier;
        candidate.reason = "contradicts the other constraints in the robust optimization";
      }
}

}  // namespace hmt::submap
