// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "start_poses.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "chordal_relaxation.hpp"
#include "pose_problem.hpp"
#include "spanning_tree.hpp"

namespace hmt::graph {
namespace {

Start make_start(const PoseGraph& graph, Initialization kind, const Chi2OfPoses& chi2_of) {
  std::optional<std::vector<Pose>> poses;
  if (kind == Initialization::chordal) poses = chordal_poses(graph);
  if (kind == Initialization::spanning_tree) poses = spanning_tree_poses(graph, held_nodes(graph));
  Start start{Initialization::given, graph.poses, 0};
  if (poses) start = {kind, std::move(*poses), 0};
  start.chi2 = chi2_of(start.poses);
  return start;
}

}  // namespace

std::vector<Start> choose_starts(const PoseGraph& graph, Initialization wanted, int restarts,
                                 const Chi2OfPoses& chi2_of) {
  std::vector<Start> starts;
  const bool all = wanted == Initialization::best || restarts > 0;
  if (wanted != Initialization::best) starts.push_back(make_start(graph, wanted, chi2_of));
  for (const Initialization kind :
       {Initialization::chordal, Initialization::given, Initialization::spanning_tree})
    if (all && kind != wanted) starts.push_back(make_start(graph, kind, chi2_of));
  if (wanted == Initialization::best) {
    // A chi2 that is not a number loses.
    const auto less = [](const Start& a, const Start& b) {
      return a.chi2 < b.chi2 || (b.chi2 != b.chi2 && a.chi2 == a.chi2);
    };
    std::stable_sort(starts.begin(), starts.end(), less);
  }
  const auto count = static_cast<size_t>(restarts) + 1;
  for (unsigned seed = 1; starts.size() < count; ++seed) {
    starts.push_back({Initialization::random_tree, random_tree_poses(graph, seed), 0});
    starts.back().chi2 = chi2_of(starts.back().poses);
  }
  starts.resize(count);
  return starts;
}

Start initial_poses(const PoseGraph& graph, Initialization wanted) {
  check_pose_graph(graph);
  const auto chi2_of = [&](const std::vector<Pose>& poses) {
    const std::vector<double> chi2 = edge_chi2(graph, poses);
    return std::accumulate(chi2.begin(), chi2.end(), 0.0);
  };
  return choose_starts(graph, wanted, 0, chi2_of).front();
}

}  // namespace hmt::graph
