// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <utility>

#include "find_loops.hpp"
#include "hmt/graph/pose_covariance.hpp"
#include "hmt/submap/link/loop_effect.hpp"
#include "hmt/submap/link/robust_solution.hpp"
#include "hmt/submap/link/thin_track.hpp"
#include "stages.hpp"
#include "whole_map.hpp"

namespace hmt::submap {
namespace {

/// A section has at least this share of the keyframes that are there already, each of which every
/// section looks at: of a log that sees ever new places the sections grow, and the time stays in
/// proportion.
constexpr double kLeastGrowth = 0.5;
/// Travel between the places that are searched for at first: what ties them to the map ties what
/// lies between them well enough to be registered without a search.
constexpr double kFirstSpacing_m = 4;
/// Bound on the rounds for a section in which loops are still found late.
constexpr int kMaxRounds = 4;

/// The keyframes up to the end of a section, and what is known of them.
struct Known {
  Track track;    ///< without observations
  int first = 0;  ///< keyframe that the section begins with
  std::vector<Pose> T_world_keyframe;
  std::vector<Constraint> constraints;
  std::vector<LoopCandidate> loops;
  SectionOverlap overlap;
};

/// Keyframes up to the end of the next section, of which `known` are placed.
size_t end_of_section(size_t known, size_t all, const SectionOptions& options) {
  const size_t size = std::max(static_cast<size_t>(options.keyframes),
                               static_cast<size_t>(kLeastGrowth * static_cast<double>(known)));
  // No short one is left for the end.
  return known + size + size / 2 >= all ? all : known + size;
}

/// The keyframe that the section begins with is the last one of the section before.
Known open_section(const MapFile& file, const Track& track, const SectionOptions& options) {
  Known known;
  known.T_world_keyframe = file.load_estimate();
  known.constraints = file.load_constraints();
  known.loops = file.load_loops();
  const size_t begin = known.T_world_keyframe.size();
  const size_t end = end_of_section(begin, track.keyframes.size(), options);
  known.first = static_cast<int>(begin) - 1;
  known.track.space = track.space;
  known.track.keyframes.assign(track.keyframes.begin(),
                               track.keyframes.begin() + static_cast<std::ptrdiff_t>(end));
  for (size_t k = begin; k < end; ++k) {
    const Constraint& step = track.odometry[k - 1];
    known.T_world_keyframe.push_back(known.T_world_keyframe.back() * step.T_a_b);
    known.constraints.push_back(step);
  }
  return known;
}

void solve(Known& known, std::span<const Constraint> constraints, const Run& run) {
  RobustSolution solution =
      solve_robustly(known.track.space, known.T_world_keyframe, constraints, {}, run);
  known.T_world_keyframe = std::move(solution.T_world_keyframe);
  known.constraints = std::move(solution.kept);
}

/// Overlap of the section at the present poses, and the registrations that it suggests.
void relate(Known& known, const MapFile& file, const Options& options, const Run& run) {
  const graph::PoseCovariance covariance(
      graph_of_all(known.track, known.T_world_keyframe, known.constraints, {}));
  const PairCovariance of_pair = [&covariance](int a, int b) {
    return covariance.relative_by_column(a, b);
  };
  known.overlap = overlap_of_section(known.track.keyframes, known.T_world_keyframe, known.first,
                                     of_pair, file, options.overlap, run);
  std::vector<Constraint> constraints = known.constraints;
  const std::vector<Constraint> found = register_overlapping(
      known.track.space, known.track.keyframes, known.T_world_keyframe, known.overlap.graph,
      known.constraints, of_pair, file, options.local, run);
  constraints.insert(constraints.end(), found.begin(), found.end());
  solve(known, constraints, run);
}

/// Whether there were loops to close.
bool close_loops(Known& known, const MapFile& file, double query_spacing_m, const Run& run) {
  const std::vector<int> no_submaps(known.track.keyframes.size(), 0);
  const LoopSearch search = {
      known.track, known.T_world_keyframe, known.constraints, {}, no_submaps, known.loops,
      known.first, query_spacing_m};
  std::vector<LoopCandidate> candidates = find_loops(search, file, run);
  const bool found = has_closure(candidates);
  if (found) {
    const RobustSolution solution =
        solve_robustly(known.track.space, known.T_world_keyframe,
                       with_closures(known.constraints, candidates), {}, run);
    mark_outliers(candidates, solution.outliers);
    known.T_world_keyframe = solution.T_world_keyframe;
    known.constraints = solution.kept;
  }
  known.loops = join_candidates(std::move(known.loops), std::move(candidates));
  return found;
}

/// Each keyframe that shows nothing new hangs on the one that shows most of it. The last one stays
/// for the next section to begin with. Where none follows all stay: they tell a little more, and
/// nobody has to make room.
std::vector<int> hosts(const Known& known, bool is_last) {
  std::vector<int> host(known.track.keyframes.size());
  std::iota(host.begin(), host.end(), 0);
  if (is_last) return host;
  const auto stays = [&](int k) {
    return known.overlap.is_reference[static_cast<size_t>(k)] != 0 || k + 1 == std::ssize(host);
  };
  for (int k = 0; k < std::ssize(host); ++k) {
    if (stays(k)) continue;
    double most = 0;
    for (const auto& neighbor : known.overlap.graph.neighbors(k)) {
      if (!stays(neighbor.node) || neighbor.weight <= most) continue;
      most = neighbor.weight;
      host[static_cast<size_t>(k)] = neighbor.node;
    }
  }
  return host;
}

}  // namespace

Track add_section(MapFile& file, const Track& track, const std::string& stage,
                  const Options& options, const Run& run) {
  Known known = open_section(file, track, options.sections);
  close_loops(known, file, kFirstSpacing_m, run);
  for (int round = 1; round <= kMaxRounds; ++round) {
    relate(known, file, options, run);
    if (round == kMaxRounds || !close_loops(known, file, LoopProblem{}.query_spacing_m, run)) break;
  }
  const bool is_last = known.track.keyframes.size() == track.keyframes.size();
  const std::vector<int> host = hosts(known, is_last);
  const std::vector<int> number = numbers_of_kept(host, track.keyframes.size());
  Track thinned = thin_track(track, host, known.T_world_keyframe);
  std::vector<Pose> T_world_kept;
  for (size_t k = 0; k < host.size(); ++k)
    if (number[k] >= 0) T_world_kept.push_back(known.T_world_keyframe[k]);
  run.log_info(stage + ": " + std::to_string(static_cast<int>(host.size()) - known.first - 1) +
               " keyframes, " +
               std::to_string(static_cast<int>(T_world_kept.size()) - known.first - 1) +
               " of which show something new");
  StageWriter writer = file.begin(stage);
  writer.put_track(thinned);
  writer.put_constraints(thin_constraints(known.constraints, number, thinned, T_world_kept.size()));
  writer.put_loops(thin_loops(known.loops, number));
  writer.put_estimate(T_world_kept);
  writer.commit();
  return thinned;
}

}  // namespace hmt::submap
