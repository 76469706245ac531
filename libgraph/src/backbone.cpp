// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "backbone.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "disjoint_sets.hpp"
#include "pose_problem.hpp"

namespace hmt::graph {
namespace {

/// Steps within which the ends of two edges are beside each other.
constexpr int kBeside = 5;

int steps_to(const std::vector<std::pair<int, int>>& steps, int node) {
  const auto place = std::lower_bound(steps.begin(), steps.end(), std::pair(node, 0));
  return place == steps.end() || place->first != node ? kBeside + 1 : place->second;
}

/// Whether the ends of two edges lie as those of two rungs do.
bool rungs(int steps_a, int steps_b) {
  return std::max(steps_a, steps_b) <= kBeside && std::abs(steps_a - steps_b) <= 1;
}

}  // namespace

std::vector<bool> least_doubted_forest(const PoseGraph& graph, const std::vector<double>& doubt) {
  std::vector<size_t> order(graph.edges.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return doubt[a] < doubt[b]; });
  DisjointSets sets(graph.poses.size());
  std::vector<bool> forest(graph.edges.size(), false);
  for (const size_t k : order) forest[k] = sets.join(graph.edges[k].from, graph.edges[k].to);
  return forest;
}

AcceptedGraph::AcceptedGraph(const PoseGraph& graph, const std::vector<bool>& accepted,
                             const std::vector<bool>& trusted)
    : graph_(graph), accepted_(accepted), trusted_(trusted), arcs_(graph.poses.size()) {
  for (size_t k = 0; k < accepted.size(); ++k) {
    if (!accepted[k]) continue;
    arcs_[static_cast<size_t>(graph.edges[k].from)].push_back({graph.edges[k].to, k});
    arcs_[static_cast<size_t>(graph.edges[k].to)].push_back({graph.edges[k].from, k});
  }
}

AcceptedGraph::Steps AcceptedGraph::steps_from(int node) const {
  Steps found = {{node, 0}};
  std::unordered_set<int> seen = {node};
  for (size_t head = 0; head < found.size() && found[head].second < kBeside; ++head) {
    const auto [at, steps] = found[head];
    for (const Arc& arc : arcs_[static_cast<size_t>(at)])
      if (trusted_[arc.edge] && seen.insert(arc.node).second)
        found.emplace_back(arc.node, steps + 1);
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<size_t> AcceptedGraph::beside(size_t k) const {
  const Steps from = steps_from(graph_.edges[k].from);
  const Steps to = steps_from(graph_.edges[k].to);
  std::vector<size_t> edges = {k};
  for (const auto& [node, steps] : from)
    for (const Arc& arc : arcs_[static_cast<size_t>(node)])
      if (!trusted_[arc.edge] && rungs(steps, steps_to(to, arc.node))) edges.push_back(arc.edge);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

bool AcceptedGraph::are_beside(size_t k, size_t l) const {
  const Steps from = steps_from(graph_.edges[k].from);
  const Steps to = steps_from(graph_.edges[k].to);
  const PoseGraphEdge& other = graph_.edges[l];
  return rungs(steps_to(from, other.from), steps_to(to, other.to)) ||
         rungs(steps_to(from, other.to), steps_to(to, other.from));
}

bool AcceptedGraph::holds_without(size_t k, const std::vector<size_t>& removed) const {
  // From both ends in turn, so that a small part that comes off is found at its own cost.
  std::unordered_map<int, int> side = {{graph_.edges[k].from, 0}, {graph_.edges[k].to, 1}};
  std::vector<int> queue[2] = {{graph_.edges[k].from}, {graph_.edges[k].to}};
  size_t head[2] = {0, 0};
  while (head[0] < queue[0].size() && head[1] < queue[1].size())
    for (const int s : {0, 1}) {
      if (head[s] == queue[s].size()) return false;
      const int at = queue[s][head[s]++];
      for (const Arc& arc : arcs_[static_cast<size_t>(at)]) {
        if (std::binary_search(removed.begin(), removed.end(), arc.edge)) continue;
        const auto [place, is_new] = side.emplace(arc.node, s);
        if (!is_new && place->second != s) return true;
        if (is_new) queue[s].push_back(arc.node);
      }
    }
  return false;
}

std::vector<int> AcceptedGraph::pieces() const {
  PoseGraph firm;
  firm.poses.resize(graph_.poses.size());
  for (size_t k = 0; k < accepted_.size(); ++k)
    if (accepted_[k] && (trusted_[k] || holds_without(k, beside(k))))
      firm.edges.push_back(graph_.edges[k]);
  return connected_components(firm);
}

}  // namespace hmt::graph
