// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "spanning_tree.hpp"

#include "pose_problem.hpp"

namespace hmt::graph {
namespace {

/// Edges at each node in index order, as one array with offsets.
struct Incidence {
  std::vector<size_t> offsets;
  std::vector<size_t> edges;
};

Incidence incidence_of(const PoseGraph& graph, const std::vector<bool>& use) {
  Incidence incidence;
  incidence.offsets.assign(graph.poses.size() + 1, 0);
  const auto used = [&use](size_t k) { return use.empty() || use[k]; };
  for (size_t k = 0; k < graph.edges.size(); ++k) {
    if (!used(k)) continue;
    ++incidence.offsets[static_cast<size_t>(graph.edges[k].from) + 1];
    ++incidence.offsets[static_cast<size_t>(graph.edges[k].to) + 1];
  }
  for (size_t node = 0; node < graph.poses.size(); ++node)
    incidence.offsets[node + 1] += incidence.offsets[node];
  incidence.edges.resize(incidence.offsets.back());
  std::vector<size_t> next = incidence.offsets;
  for (size_t k = 0; k < graph.edges.size(); ++k) {
    if (!used(k)) continue;
    incidence.edges[next[static_cast<size_t>(graph.edges[k].from)]++] = k;
    incidence.edges[next[static_cast<size_t>(graph.edges[k].to)]++] = k;
  }
  return incidence;
}

}  // namespace

std::vector<Pose> spanning_tree_poses(const PoseGraph& graph, const std::vector<bool>& use) {
  const Incidence incidence = incidence_of(graph, use);
  std::vector<bool> placed = held_nodes(graph);
  std::vector<Pose> poses = graph.poses;
  std::vector<size_t> queue;
  for (size_t node = 0; node < placed.size(); ++node)
    if (placed[node]) queue.push_back(node);
  for (size_t head = 0; head < queue.size(); ++head) {
    const size_t node = queue[head];
    for (size_t i = incidence.offsets[node]; i < incidence.offsets[node + 1]; ++i) {
      const PoseGraphEdge& edge = graph.edges[incidence.edges[i]];
      const bool forward = static_cast<size_t>(edge.from) == node;
      const auto other = static_cast<size_t>(forward ? edge.to : edge.from);
      if (placed[other]) continue;
      placed[other] = true;
      poses[other] = poses[node] * (forward ? edge.T_from_to : edge.T_from_to.inverse());
      queue.push_back(other);
    }
  }
  return poses;
}

}  // namespace hmt::graph
