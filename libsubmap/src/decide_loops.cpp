// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/decide_loops.hpp"

#include <algorithm>
#include <string>

#include "continue_run.hpp"
#include "hmt/submap/link/loop_effect.hpp"
#include "hmt/submap/link/robust_solution.hpp"
#include "link/loop_patch.hpp"

namespace hmt::submap {
namespace {

/// The candidate of that id, if it can be decided about.
LoopCandidate& decided(HybridMap& map, int id) {
  if (id < 0 || static_cast<size_t>(id) >= map.loops.size())
    throw InputError("there is no loop candidate " + std::to_string(id) + ": the map has " +
                     std::to_string(map.loops.size()) + ", the first is 0");
  return map.loops[static_cast<size_t>(id)];
}

void accept(HybridMap& map, int id) {
  LoopCandidate& candidate = decided(map, id);
  if (candidate.information.isZero(0))
    throw InputError("loop candidate " + std::to_string(id) +
                     " has no match that could be accepted");
  candidate.verdict = LoopVerdict::confirmed;
  candidate.reason = "accepted by the user";
}

void reject(HybridMap& map, std::span<const Pose> T_world_keyframe, std::span<const double> path_m,
            int id) {
  LoopCandidate& rejected = decided(map, id);
  rejected.verdict = LoopVerdict::rejected;
  rejected.reason = "rejected by the user";
  for (LoopCandidate& candidate : map.loops) {
    if (candidate.verdict != LoopVerdict::accepted ||
        !tells_the_same(rejected, candidate, T_world_keyframe, path_m))
      continue;
    candidate.verdict = LoopVerdict::rejected;
    candidate.reason = "tells the same as candidate " + std::to_string(id) + ", which was rejected";
  }
}

void apply(HybridMap& map, std::span<const Pose> T_world_keyframe, const LoopDecisions& decisions) {
  for (const int id : decisions.reject)
    if (std::count(decisions.accept.begin(), decisions.accept.end(), id) > 0)
      throw InputError("loop candidate " + std::to_string(id) + " is both accepted and rejected");
  const std::vector<double> path_m = path_lengths(T_world_keyframe);
  for (const int id : decisions.reject) reject(map, T_world_keyframe, path_m, id);
  for (const int id : decisions.accept) accept(map, id);
}

/// What holds without any doubt, and the closures.
std::vector<Constraint> constraints_to_begin_with(const HybridMap& map) {
  std::vector<Constraint> constraints;
  std::copy_if(map.constraints.begin(), map.constraints.end(), std::back_inserter(constraints),
               is_within_visit);
  for (const LoopCandidate& candidate : map.loops)
    if (is_closure(candidate.verdict)) constraints.push_back(as_constraint(candidate));
  return constraints;
}

std::string next_stage(const MapFile& file) {
  int number = 1;
  while (file.finished("decision" + std::to_string(number))) ++number;
  return "decision" + std::to_string(number);
}

}  // namespace

BuildResult decide_loops(const std::filesystem::path& path, const LoopDecisions& decisions,
                         const Run& run) {
  BuildResult result{MapFile::open_for_change(path), {}};
  MapFile& file = result.file;
  if (!file.complete())
    throw InputError(path.string() + ": the map is not finished; run hmtmap map again first");
  HybridMap map = file.load_map();
  const std::vector<Pose> T_world_keyframe = file.load_estimate();
  apply(map, T_world_keyframe, decisions);
  const RobustSolution solution = solve_robustly(
      map.track.space, T_world_keyframe, constraints_to_begin_with(map), map.sightings, run);
  StageWriter writer = file.begin(next_stage(file));
  writer.reopen();
  writer.put_loops(map.loops);
  writer.put_constraints(solution.kept);
  writer.put_sightings(solution.kept_sightings);
  writer.put_estimate(solution.T_world_keyframe);
  writer.commit();
  result.times = continue_run(file, options_from_json(file.origin().options_json), run);
  return result;
}

}  // namespace hmt::submap
