// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "hmt/graph/pose_covariance.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/link/loop_effect.hpp"
#include "hmt/submap/link/robust_solution.hpp"
#include "hmt/submap/link/settle_submaps.hpp"
#include "link/loop_patch.hpp"
#include "stages.hpp"
#include "whole_map.hpp"

namespace hmt::submap {
namespace {

// The poses stand once a round moves none by more than this, far below what a sensor resolves:
// overlap and partition would come out the same again.
constexpr double kSettledMove_m = 0.02;
constexpr double kSettledTurn_rad = 0.005;
// ... but for a few stray keyframes, which one constraint more or less lets go to and fro.
constexpr double kStrayShare = 0.01;
constexpr double kStrayMove_m = 0.1;
// Deviations of a relative pose within which registration finds the right match from the prediction
// alone.
constexpr double kTied_m = 0.1;
constexpr double kTied_rad = 0.03;

/// Differences between two sets of poses of the keyframes.
struct Move {
  double metres = 0;  ///< the largest
  double radians = 0;
  int unsettled = 0;  ///< keyframes that moved by more than overlap could ignore
  int keyframes = 0;

  bool is_settled() const { return metres <= kStrayMove_m && unsettled <= kStrayShare * keyframes; }
};

Move move_between(std::span<const Pose> before, std::span<const Pose> after) {
  Move move;
  move.keyframes = static_cast<int>(before.size());
  for (size_t k = 0; k < before.size(); ++k) {
    const Vector6d d = graph::boxminus(after[k], before[k]);
    const double metres = d.head<3>().norm();
    const double radians = d.tail<3>().norm();
    move.metres = std::max(move.metres, metres);
    move.radians = std::max(move.radians, radians);
    if (metres > kSettledMove_m || radians > kSettledTurn_rad) ++move.unsettled;
  }
  return move;
}

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

std::vector<LoopCandidate> find_loops(const HybridMap& map, std::span<const Pose> T_world_keyframe,
                                      const MapFile& file, const Run& run) {
  graph::PoseGraph graph =
      graph_of_all(map.track, T_world_keyframe, map.constraints, map.sightings);
  const graph::PoseCovariance covariance(graph);
  LoopProblem problem;
  problem.space = map.track.space;
  problem.keyframes = map.track.keyframes;
  problem.T_world_keyframe = T_world_keyframe;
  problem.submap = map.submap_of_keyframe;
  problem.covariance = [&covariance](int a, int b) { return covariance.relative(a, b); };
  // What is known this well the next round's overlap registers without a search.
  problem.already_tied = [&problem](int a, int b) {
    if (std::abs(a - b) <= kVisitGap) return true;
    const auto known = problem.covariance(a, b);
    return known && known->topLeftCorner<3, 3>().trace() < kTied_m * kTied_m &&
           known->bottomRightCorner<3, 3>().trace() < kTied_rad * kTied_rad;
  };
  problem.observations = &file;
  std::vector<LoopCandidate> candidates = search_loops(problem, run);
  reject_again(candidates, map.loops, T_world_keyframe);
  return consistent_loops(std::move(candidates), graph);
}

std::vector<Constraint> with_loops(std::vector<Constraint> constraints,
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

/// New loop closures change what overlaps: the next round starts from the poses that they give.
void take_loops(MapFile& file, const HybridMap& map, std::vector<LoopCandidate> candidates,
                const std::string& stage, const Run& run) {
  const RobustSolution solution =
      solve_robustly(map.track.space, keyframe_poses(map), with_loops(map.constraints, candidates),
                     map.sightings, run);
  mark_outliers(candidates, solution.outliers);
  candidates = join_candidates(map.loops, std::move(candidates));
  StageWriter writer = file.begin(stage);
  writer.put_loops(candidates);
  writer.put_estimate(solution.T_world_keyframe);
  writer.put_constraints(solution.kept);
  writer.put_sightings(solution.kept_sightings);
  writer.commit();
}

graph::PoseOptimizerResult optimize_all(const HybridMap& map, std::span<const Pose> start,
                                        const Run& run) {
  graph::PoseOptimizerOptions options;
  options.threads = run.threads;
  return graph::optimize(graph_of_all(map.track, start, map.constraints, map.sightings), options);
}

/// The map's last poses: all submaps settled against each other, then all keyframes refined
/// together, so that the division into submaps costs no accuracy. `flat`: the same optimum reached
/// without submaps.
graph::PoseOptimizerResult refine_settled(const HybridMap& map,
                                          const graph::PoseOptimizerReport& flat,
                                          DivisionCost& division, const Run& run) {
  // Submaps with landmarks hang together by these too: they stay where the links put them.
  const std::vector<Pose> by_submaps =
      map.sightings.empty()
          ? settle_submaps(map.track.space, map.submaps, map.T_world_submap, map.constraints)
          : keyframe_poses(map);
  graph::PoseOptimizerResult refined = optimize_all(map, by_submaps, run);
  division = {refined.report.chi2_initial, refined.report.chi2, flat.chi2};
  return refined;
}

/// Refines the poses of all keyframes together and ends the rounds if they stand.
void refine(MapFile& file, HybridMap map, std::vector<LoopCandidate> candidates,
            const std::string& stage, bool last_round, const Run& run) {
  const std::vector<Pose> before = file.load_estimate();
  graph::PoseOptimizerResult result = optimize_all(map, before, run);
  const Move move = move_between(before, result.poses);
  run.log_info(stage + ": keyframes moved by up to " + std::to_string(move.metres) + " m, " +
               std::to_string(move.radians) + " rad; " + std::to_string(move.unsettled) + " of " +
               std::to_string(move.keyframes) + " by more than 2 cm or 0.3 deg");
  const bool settled = last_round || move.is_settled();
  MapSolution solution = file.load_solution();
  candidates = join_candidates(map.loops, std::move(candidates));
  if (settled) result = refine_settled(map, result.report, solution.division, run);
  graph::PoseGraph all = graph_of_all(map.track, result.poses, map.constraints, map.sightings);
  all.points = result.points;
  if (settled) rate_effects(candidates, all, map.constraints, run.threads);
  move_submaps(map, result.poses);
  solution.T_world_submap = map.T_world_submap;
  add_covariances(all, map.track, map.submaps, map.sightings, solution);
  StageWriter writer = file.begin(settled ? kSettled : stage);
  writer.put_loops(candidates);
  writer.put_estimate(result.poses);
  for (const Submap& submap : map.submaps) writer.put_submap(submap);
  writer.put_solution(solution);
  writer.commit();
}

}  // namespace

void close_loops(MapFile& file, const std::string& stage, bool last_round, const Run& run) {
  const HybridMap map = file.load_map();
  std::vector<LoopCandidate> candidates;
  // A loop that is found in the last round could not be made part of the submaps any more.
  // Landmarks are their own loop closures.
  if (!last_round && map.sightings.empty())
    candidates = find_loops(map, keyframe_poses(map), file, run);
  const bool found = std::any_of(candidates.begin(), candidates.end(),
                                 [](const LoopCandidate& c) { return is_closure(c.verdict); });
  if (found) return take_loops(file, map, std::move(candidates), stage, run);
  refine(file, map, std::move(candidates), stage, last_round, run);
}

}  // namespace hmt::submap
