// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "spanning_tree.hpp"

#include <random>
#include <utility>

#include "pose_problem.hpp"

namespace hmt::graph {
namespace {

/// Edges at each node in index order, as one array with offsets.
struct Incidence {
  std::vector<size_t> offsets;
  std::vector<size_t> edges;
};

Incidence incidence_of(const PoseGraph& graph) {
  Incidence incidence;
  incidence.offsets.assign(graph.poses.size() + 1, 0);
  for (const PoseGraphEdge& edge : graph.edges) {
    ++incidence.offsets[static_cast<size_t>(edge.from) + 1];
    ++incidence.offsets[static_cast<size_t>(edge.to) + 1];
  }
  for (size_t node = 0; node < graph.poses.size(); ++node)
    incidence.offsets[node + 1] += incidence.offsets[node];
  incidence.edges.resize(incidence.offsets.back());
  std::vector<size_t> next = incidence.offsets;
  for (size_t k = 0; k < graph.edges.size(); ++k) {
    incidence.edges[next[static_cast<size_t>(graph.edges[k].from)]++] = k;
    incidence.edges[next[static_cast<size_t>(graph.edges[k].to)]++] = k;
  }
  return incidence;
}

/// Places the neighbours of a node that have no place yet and appends them to `placed`.
void grow_from(const PoseGraph& graph, const Incidence& incidence, size_t node,
               std::vector<bool>& done, std::vector<Pose>& poses, std::vector<size_t>& placed) {
  for (size_t i = incidence.offsets[node]; i < incidence.offsets[node + 1]; ++i) {
    const PoseGraphEdge& edge = graph.edges[incidence.edges[i]];
    const bool forward = static_cast<size_t>(edge.from) == node;
    const auto other = static_cast<size_t>(forward ? edge.to : edge.from);
    if (done[other]) continue;
    done[other] = true;
    poses[other] = poses[node] * (forward ? edge.T_from_to : edge.T_from_to.inverse());
    placed.push_back(other);
  }
}

}  // namespace

std::vector<Pose> spanning_tree_poses(const PoseGraph& graph, const std::vector<bool>& placed) {
  const Incidence incidence = incidence_of(graph);
  const std::vector<int> component = connected_components(graph);
  std::vector<bool> rooted(placed.size(), false);
  for (size_t node = 0; node < placed.size(); ++node)
    if (placed[node]) rooted[static_cast<size_t>(component[node])] = true;
  const std::vector<bool> held = held_nodes(graph);
  std::vector<bool> done = placed;
  std::vector<size_t> queue;
  for (size_t node = 0; node < placed.size(); ++node) {
    if (!rooted[static_cast<size_t>(component[node])] && held[node]) done[node] = true;
    if (done[node]) queue.push_back(node);
  }
  std::vector<Pose> poses = graph.poses;
  for (size_t head = 0; head < queue.size(); ++head)
    grow_from(graph, incidence, queue[head], done, poses, queue);
  return poses;
}

std::vector<Pose> random_tree_poses(const PoseGraph& graph, unsigned seed) {
  const Incidence incidence = incidence_of(graph);
  std::vector<bool> done = held_nodes(graph);
  std::vector<size_t> front;
  for (size_t node = 0; node < done.size(); ++node)
    if (done[node]) front.push_back(node);
  std::vector<Pose> poses = graph.poses;
  std::mt19937 generator(seed);
  while (!front.empty()) {
    // Not std::uniform_int_distribution, whose numbers differ between standard libraries.
    std::swap(front[generator() % front.size()], front.back());
    const size_t node = front.back();
    front.pop_back();
    grow_from(graph, incidence, node, done, poses, front);
  }
  return poses;
}

}  // namespace hmt::graph
