// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/submap_optimizer.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "best_first.hpp"
#include "hmt/graph/input_error.hpp"
#include "hmt/graph/pose_covariance.hpp"
#include "pose_problem.hpp"

namespace hmt::graph {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A part of the graph in a frame of its own: that of its first node.
struct Submap {
  std::vector<int> nodes;  ///< of the whole graph, ascending
  PoseGraph graph;         ///< poses T_submap_node
  std::optional<PoseCovariance> covariance;
};

WeightedGraph arcs_of(const PoseGraph& graph) {
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(graph.edges.size());
  for (const PoseGraphEdge& edge : graph.edges) pairs.push_back(std::minmax(edge.from, edge.to));
  std::sort(pairs.begin(), pairs.end());
  std::vector<Arc> arcs;
  arcs.reserve(pairs.size());
  for (size_t k = 0; k < pairs.size(); ++k) {
    if (k > 0 && pairs[k] == pairs[k - 1])
      arcs.back().weight += 1;
    else
      arcs.push_back({pairs[k].first, pairs[k].second, 1});
  }
  return {static_cast<int>(graph.poses.size()), arcs};
}

/// Submap of every node. A group that its own edges do not hold together is several submaps.
std::vector<int> cut(const PoseGraph& graph, int submap_size, int threads) {
  const auto nodes = static_cast<int>(graph.poses.size());
  if (nodes == 0) return {};
  const int groups = std::max(1, (nodes + submap_size - 1) / submap_size);
  const Labels labels = coarse_best_first_labels(arcs_of(graph), groups, threads);
  PoseGraph inside;
  inside.poses.resize(graph.poses.size());
  for (const PoseGraphEdge& edge : graph.edges)
    if (labels[static_cast<size_t>(edge.from)] == labels[static_cast<size_t>(edge.to)])
      inside.edges.push_back(edge);
  return connected_components(inside);
}

std::vector<Submap> divide(const PoseGraph& graph, const std::vector<int>& submap_of) {
  std::vector<Submap> submaps;
  std::vector<int> place(submap_of.size());
  for (size_t node = 0; node < submap_of.size(); ++node) {
    const auto s = static_cast<size_t>(submap_of[node]);
    if (s >= submaps.size()) submaps.resize(s + 1);
    place[node] = static_cast<int>(submaps[s].nodes.size());
    submaps[s].nodes.push_back(static_cast<int>(node));
    const Pose& T_world_frame = graph.poses[static_cast<size_t>(submaps[s].nodes.front())];
    submaps[s].graph.poses.push_back(relative_pose(T_world_frame, graph.poses[node]));
    submaps[s].graph.space = graph.space;
  }
  for (PoseGraphEdge edge : graph.edges) {
    const int s = submap_of[static_cast<size_t>(edge.from)];
    if (s != submap_of[static_cast<size_t>(edge.to)]) continue;
    edge.from = place[static_cast<size_t>(edge.from)];
    edge.to = place[static_cast<size_t>(edge.to)];
    submaps[static_cast<size_t>(s)].graph.edges.push_back(edge);
  }
  return submaps;
}

template <class Function>
void for_each(size_t count, int threads, const Function& function) {
  tbb::task_arena(threads).execute([&] { tbb::parallel_for(size_t{0}, count, function); });
}

void solve_submap(Submap& submap, int max_iterations) {
  PoseOptimizerOptions options;
  options.initialization = Initialization::best;
  options.max_iterations = max_iterations;
  submap.graph.poses = optimize(submap.graph, options).poses;
  submap.covariance.emplace(submap.graph);
}

/// Condenses edges between the submaps `a` < `b` into one relative pose of their frames: each edge
/// is carried to the frames, T_a_b = T_a_i T_i_j T_b_j^-1, with the covariance of all three
/// factors, and the two-node graph of all of them is solved. Nothing where the edges leave T_a_b
/// open.
template <class Chart>
std::optional<PoseGraphEdge> condense(const PoseGraph& graph, const std::vector<Submap>& submaps,
                                      int a, int b, const std::vector<PoseGraphEdge>& edges) {
  PoseGraph pair;
  pair.space = graph.space;
  for (const PoseGraphEdge& edge : edges) {
    const Submap& from = submaps[static_cast<size_t>(a)];
    const Submap& to = submaps[static_cast<size_t>(b)];
    const auto cov_from = from.covariance->relative(0, edge.from);
    const auto cov_to = to.covariance->relative(edge.to, 0);
    const auto information = chart_block<Chart>(edge.information);
    if (!cov_from || !cov_to || !is_definite(information)) continue;
    using Matrix = std::decay_t<decltype(information)>;
    const Matrix measured = information.llt().solve(Matrix::Identity());
    const Pose T_j_b = to.graph.poses[static_cast<size_t>(edge.to)].inverse();
    const Pose T_i_b = edge.T_from_to * T_j_b;
    const Matrix6d cov_i_b = compose_covariance(T_j_b, from_chart_block<Chart>(measured), *cov_to);
    const Matrix sum = chart_block<Chart>(compose_covariance(T_i_b, *cov_from, cov_i_b));
    const Matrix sum_information = sum.llt().solve(Matrix::Identity());
    const Matrix symmetric = (sum_information + sum_information.transpose()) / 2;
    pair.edges.push_back({0, 1, from.graph.poses[static_cast<size_t>(edge.from)] * T_i_b,
                          from_chart_block<Chart>(symmetric)});
  }
  if (pair.edges.empty()) return std::nullopt;
  pair.poses = {Pose{}, pair.edges.front().T_from_to};
  const Pose T_a_b = optimize(pair, {}).poses[1];
  const auto covariance = PoseCovariance(pair).marginal(1);
  if (!covariance) return std::nullopt;
  const auto block = chart_block<Chart>(*covariance);
  using Matrix = std::decay_t<decltype(block)>;
  const Matrix information = block.llt().solve(Matrix::Identity());
  return PoseGraphEdge{a, b, T_a_b,
                       from_chart_block<Chart>((information + information.transpose()) / 2)};
}

/// Edges between submaps by pair (a < b), their ends numbered within the submaps.
std::map<std::pair<int, int>, std::vector<PoseGraphEdge>> edges_between(
    const PoseGraph& graph, const std::vector<Submap>& submaps, const std::vector<int>& submap_of) {
  const auto place = [&](int node) {
    const auto& nodes = submaps[static_cast<size_t>(submap_of[static_cast<size_t>(node)])].nodes;
    return static_cast<int>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
  };
  std::map<std::pair<int, int>, std::vector<PoseGraphEdge>> between;
  for (const PoseGraphEdge& edge : graph.edges) {
    const int a = submap_of[static_cast<size_t>(edge.from)];
    const int b = submap_of[static_cast<size_t>(edge.to)];
    if (a == b) continue;
    PoseGraphEdge local{place(edge.from), place(edge.to), edge.T_from_to, edge.information};
    if (a > b) {
      // The same edge from the other end; its information moves by the adjoint of T_from_to.
      std::swap(local.from, local.to);
      const Matrix6d Ad = adjoint(edge.T_from_to.inverse());
      local.T_from_to = edge.T_from_to.inverse();
      local.information = Ad.transpose() * edge.information * Ad;
      local.information = ((local.information + local.information.transpose()) / 2).eval();
    }
    between[std::minmax(a, b)].push_back(local);
  }
  return between;
}

/// The graph of submap frames, each pose where its first node is in the given poses.
PoseGraph graph_of_submaps(const PoseGraph& graph, const std::vector<Submap>& submaps,
                           const std::vector<int>& submap_of, int threads) {
  const auto between = edges_between(graph, submaps, submap_of);
  const std::vector<std::pair<std::pair<int, int>, std::vector<PoseGraphEdge>>> pairs(
      between.begin(), between.end());
  std::vector<std::optional<PoseGraphEdge>> links(pairs.size());
  for_each(pairs.size(), threads, [&](size_t k) {
    links[k] = with_chart(graph.space, [&](auto chart) {
      return condense<decltype(chart)>(graph, submaps, pairs[k].first.first, pairs[k].first.second,
                                       pairs[k].second);
    });
  });
  PoseGraph top;
  top.space = graph.space;
  for (const Submap& submap : submaps)
    top.poses.push_back(graph.poses[static_cast<size_t>(submap.nodes.front())]);
  for (const auto& link : links)
    if (link) top.edges.push_back(*link);
  return top;
}

/// T_world_node of all nodes, moved as a whole so that a held node of each component lies where it
/// is held.
std::vector<Pose> place_nodes(const PoseGraph& graph, const std::vector<Submap>& submaps,
                              const std::vector<Pose>& T_top_submap) {
  std::vector<Pose> poses(graph.poses.size());
  for (size_t s = 0; s < submaps.size(); ++s)
    for (size_t k = 0; k < submaps[s].nodes.size(); ++k)
      poses[static_cast<size_t>(submaps[s].nodes[k])] = T_top_submap[s] * submaps[s].graph.poses[k];
  const std::vector<int> component = connected_components(graph);
  const std::vector<bool> held = held_nodes(graph);
  std::vector<std::optional<Pose>> T_world_top(graph.poses.size());
  for (size_t node = 0; node < held.size(); ++node) {
    auto& move = T_world_top[static_cast<size_t>(component[node])];
    if (held[node] && !move) move = graph.poses[node] * poses[node].inverse();
  }
  for (size_t node = 0; node < held.size(); ++node)
    poses[node] = held[node]
                      ? graph.poses[node]
                      : T_world_top[static_cast<size_t>(component[node])].value() * poses[node];
  return poses;
}

void check(const PoseGraph& graph, const PoseOptimizerOptions& options, int submap_size) {
  check_pose_graph(graph);
  if (submap_size < 2)
    throw InputError("submap_size is " + std::to_string(submap_size) + "; it must be at least 2");
  if (options.robust != RobustMethod::none)
    throw InputError("optimization by submaps takes robust none only; solve flat instead");
  if (!graph.points.empty())
    throw InputError("optimization by submaps takes graphs without points; solve flat instead");
}

}  // namespace

SubmapOptimizerResult optimize_by_submaps(const PoseGraph& graph,
                                          const PoseOptimizerOptions& options, int submap_size) {
  check(graph, options, submap_size);
  SubmapOptimizerResult output;
  SubmapReport& report = output.submaps;
  const Clock::time_point begin = Clock::now();
  const std::vector<int> submap_of = cut(graph, submap_size, options.threads);
  report.partition_s = seconds_since(begin);

  const Clock::time_point divided = Clock::now();
  std::vector<Submap> submaps = divide(graph, submap_of);
  for_each(submaps.size(), options.threads,
           [&](size_t s) { solve_submap(submaps[s], options.max_iterations); });
  report.submaps = static_cast<int>(submaps.size());
  report.submaps_s = seconds_since(divided);

  const Clock::time_point solved = Clock::now();
  PoseGraph top = graph_of_submaps(graph, submaps, submap_of, options.threads);
  PoseOptimizerOptions top_options;
  top_options.initialization = Initialization::best;
  top.poses = optimize(top, top_options).poses;
  report.links = static_cast<int>(top.edges.size());
  PoseGraph placed = graph;
  placed.poses = place_nodes(graph, submaps, top.poses);
  report.links_s = seconds_since(solved);

  // Their factors are as large as that of the whole graph, which comes next.
  submaps.clear();
  const Clock::time_point joined = Clock::now();
  PoseOptimizerOptions refinement = options;
  refinement.initialization = Initialization::given;
  refinement.restarts = 0;
  output.result = optimize(placed, refinement);
  report.refinement_s = seconds_since(joined);
  report.chi2_before_refinement = output.result.report.chi2_initial;
  const std::vector<double> chi2 = factor_chi2(graph, {graph.poses, {}});
  output.result.report.chi2_initial = std::accumulate(chi2.begin(), chi2.end(), 0.0);
  output.result.report.solve_s = seconds_since(begin);
  return output;
}

}  // namespace hmt::graph
