// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "find_loops.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/link/loop_effect.hpp"
#include "hmt/submap/link/robust_solution.hpp"
#include "hmt/submap/link/settle_submaps.hpp"
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

/// The search knew the submaps of its round.
void name_submaps(std::vector<LoopCandidate>& candidates, std::span<const int> submap_of_keyframe) {
  for (LoopCandidate& candidate : candidates) {
    candidate.submap_a = submap_of_keyframe[static_cast<size_t>(candidate.a)];
    candidate.submap_b = submap_of_keyframe[static_cast<size_t>(candidate.b)];
  }
}

/// New loop closures change what overlaps: the next round starts from the poses that they give.
void take_loops(MapFile& file, const HybridMap& map, std::vector<LoopCandidate> candidates,
                const std::string& stage, const Run& run) {
  const RobustSolution solution =
      solve_robustly(map.track.space, keyframe_poses(map),
                     with_closures(map.constraints, candidates), map.sightings, run);
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
  name_submaps(candidates, map.submap_of_keyframe);
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
  // Landmarks are their own loop closures; scans may know places that show none.
  if (!last_round && has_scans(map.track, file)) {
    const std::vector<Pose> T_world_keyframe = keyframe_poses(map);
    const LoopSearch search = {map.track,     T_world_keyframe,       map.constraints,
                               map.sightings, map.submap_of_keyframe, map.loops};
    candidates = find_loops(search, file, run);
  }
  if (has_closure(candidates)) return take_loops(file, map, std::move(candidates), stage, run);
  refine(file, map, std::move(candidates), stage, last_round, run);
}

}  // namespace hmt::submap
