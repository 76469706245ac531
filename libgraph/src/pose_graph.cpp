// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <numeric>
#include <string>

#include "hmt/graph/input_error.hpp"
#include "pose_problem.hpp"

namespace hmt::graph {
namespace {

bool is_finite(const Pose& pose) {
  return pose.translation.allFinite() && pose.rotation.coeffs().allFinite() &&
         pose.rotation.squaredNorm() > 0.25;
}

template <class Chart>
bool has_valid_information(const PoseGraphEdge& edge) {
  const auto block = chart_block<Chart>(edge.information);
  return is_definite(block) || is_semidefinite(block);
}

/// What is wrong with an edge; nothing where it is valid.
std::string fault_of(const PoseGraphEdge& edge, Space space, size_t num_poses) {
  for (const int node : {edge.from, edge.to})
    if (node < 0 || static_cast<size_t>(node) >= num_poses)
      return "node " + std::to_string(node) + " is outside the graph of " +
             std::to_string(num_poses) + " poses";
  if (edge.from == edge.to) return "joins a node to itself; leave it out";
  if (!is_finite(edge.T_from_to)) return "the relative pose is not finite";
  if (!edge.information.allFinite()) return "the information matrix is not finite";
  if (!edge.information.isApprox(edge.information.transpose(), 1e-9))
    return "the information matrix is not symmetric";
  if (!(space == Space::se2 ? has_valid_information<PlanarChart>(edge)
                            : has_valid_information<SpatialChart>(edge)))
    return "the information matrix has a negative eigenvalue; correct it or take the nearest "
           "positive semidefinite one";
  return {};
}

void check_edge(const PoseGraphEdge& edge, size_t index, Space space, size_t num_poses) {
  const std::string fault = fault_of(edge, space, num_poses);
  if (!fault.empty())
    throw InputError("pose graph edge " + std::to_string(index) + " (" + std::to_string(edge.from) +
                     " -> " + std::to_string(edge.to) + "): " + fault);
}

int find_root(std::vector<int>& parent, int node) {
  while (parent[static_cast<size_t>(node)] != node) {
    int& up = parent[static_cast<size_t>(node)];
    up = parent[static_cast<size_t>(up)];
    node = up;
  }
  return node;
}

}  // namespace

void check_pose_graph(const PoseGraph& graph) {
  for (size_t node = 0; node < graph.poses.size(); ++node)
    if (!is_finite(graph.poses[node]))
      throw InputError("pose graph node " + std::to_string(node) + ": the pose is not finite");
  for (const int node : graph.fixed)
    if (node < 0 || static_cast<size_t>(node) >= graph.poses.size())
      throw InputError("fixed node " + std::to_string(node) + " is outside the graph of " +
                       std::to_string(graph.poses.size()) + " poses");
  check_edges(graph.edges, graph.space, graph.poses.size());
}

void check_edges(std::span<const PoseGraphEdge> edges, Space space, size_t num_poses) {
  for (size_t k = 0; k < edges.size(); ++k) check_edge(edges[k], k, space, num_poses);
}

std::vector<int> connected_components(const PoseGraph& graph) {
  // Union by smaller root, so the root of a component is its smallest node.
  std::vector<int> parent(graph.poses.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const PoseGraphEdge& edge : graph.edges) {
    const int a = find_root(parent, edge.from);
    const int b = find_root(parent, edge.to);
    parent[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
  }
  int count = 0;
  std::vector<int> component(graph.poses.size());
  for (size_t node = 0; node < component.size(); ++node) {
    const int root = find_root(parent, static_cast<int>(node));
    component[node] =
        root == static_cast<int>(node) ? count++ : component[static_cast<size_t>(root)];
  }
  return component;
}

std::vector<bool> held_nodes(const PoseGraph& graph) {
  const std::vector<int> component = connected_components(graph);
  std::vector<bool> held(graph.poses.size(), false);
  std::vector<bool> anchored(graph.poses.size(), false);
  for (const int node : graph.fixed) {
    held[static_cast<size_t>(node)] = true;
    anchored[static_cast<size_t>(component[static_cast<size_t>(node)])] = true;
  }
  for (size_t node = 0; node < held.size(); ++node) {
    const auto own = static_cast<size_t>(component[node]);
    if (!anchored[own]) held[node] = anchored[own] = true;
  }
  return held;
}

}  // namespace hmt::graph
