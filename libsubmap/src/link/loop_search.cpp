// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/loop_search.hpp"

#include <algorithm>
#include <tuple>

#include "loop_match.hpp"
#include "loop_rivals.hpp"
#include "parallel.hpp"

namespace hmt::submap {
namespace {

/// Work between two looks at progress and at the wish to stop.
constexpr size_t kMapsPerBatch = 32;

/// The proposals of one map: [first, last).
struct MapGroup {
  size_t first = 0;
  size_t last = 0;
};

std::vector<MapGroup> group_by_map(std::span<const LoopProposal> proposals) {
  std::vector<MapGroup> groups;
  for (size_t i = 0; i < proposals.size(); ++i) {
    if (groups.empty() || proposals[groups.back().first].a != proposals[i].a)
      groups.push_back({i, i});
    groups.back().last = i + 1;
  }
  return groups;
}

/// The scans of the keyframes that any map or query is made of; the others stay empty.
std::vector<PlanarScan> load_scans(const LoopProblem& problem, std::span<const double> path_m,
                                   std::span<const LoopProposal> proposals, const Run& run) {
  std::vector<char> needed(problem.keyframes.size(), 0);
  const auto mark = [&](int center, double reach_m) {
    const auto [first, last] = patch_range(path_m, center, reach_m);
    std::fill(needed.begin() + first, needed.begin() + last + 1, char{1});
  };
  for (const LoopProposal& proposal : proposals) {
    mark(proposal.a, kMapReachM);
    mark(proposal.b, kQueryReachM);
  }
  std::vector<PlanarScan> scans(problem.keyframes.size());
  for_each_index(0, scans.size(), run.threads, [&](size_t k) {
    if (needed[k] == 0) return;
    const auto observation = problem.observations->load(problem.keyframes[k].observation);
    scans[k] = problem.space == Space::se2
                   ? make_planar_scan(*observation)
                   : make_upright_scan(
                         make_surface(*observation),
                         level_pose(problem.space, problem.T_world_keyframe[k]).T_level_robot);
  });
  return scans;
}

/// Two maps may have given the same pair; the better score stays.
std::vector<LoopCandidate> in_order(std::vector<LoopCandidate> candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const LoopCandidate& l, const LoopCandidate& r) {
                     return std::tuple(l.a, l.b, l.verdict, -l.score) <
                            std::tuple(r.a, r.b, r.verdict, -r.score);
                   });
  const auto same = [](const LoopCandidate& l, const LoopCandidate& r) {
    return l.a == r.a && l.b == r.b;
  };
  candidates.erase(std::unique(candidates.begin(), candidates.end(), same), candidates.end());
  return candidates;
}

}  // namespace

std::vector<LoopCandidate> search_loops(const LoopProblem& problem, const Run& run) {
  const std::vector<double> path_m = path_lengths(problem.T_world_keyframe);
  const std::vector<LoopProposal> proposals = propose_loops(problem, path_m, run.threads);
  if (proposals.empty()) return {};
  const std::vector<PlanarScan> scans = load_scans(problem, path_m, proposals, run);
  const std::vector<MapGroup> groups = group_by_map(proposals);
  std::vector<LoopCandidate> candidates(proposals.size());
  for (size_t first = 0; first < groups.size(); first += kMapsPerBatch) {
    if (run.stop_requested()) throw Interrupted{};
    const size_t last = std::min(groups.size(), first + kMapsPerBatch);
    for_each_index(first, last, run.threads, [&](size_t g) {
      LoopMap map(problem,
                  make_patch(problem, path_m, scans, proposals[groups[g].first].a, kMapReachM));
      for (size_t i = groups[g].first; i < groups[g].last; ++i)
        candidates[i] = examine_loop(
            problem, scans, map, make_patch(problem, path_m, scans, proposals[i].b, kQueryReachM),
            proposals[i]);
    });
    run.report({"loops", static_cast<double>(last), static_cast<double>(groups.size())});
  }
  refuse_rivals(problem, candidates);
  return in_order(std::move(candidates));
}

}  // namespace hmt::submap
