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

void check_point_edge(const PointEdge& edge, size_t index, const PoseGraph& graph) {
  const std::string name = "pose graph point edge " + std::to_string(index) + " (node " +
                           std::to_string(edge.node) + ", point " + std::to_string(edge.point) +
                           "): ";
  if (edge.node < 0 || static_cast<size_t>(edge.node) >= graph.poses.size())
    throw InputError(name + "the graph has " + std::to_string(graph.poses.size()) + " poses");
  if (edge.point < 0 || static_cast<size_t>(edge.point) >= graph.points.size())
    throw InputError(name + "the graph has " + std::to_string(graph.points.size()) + " points");
  if (!edge.p_node.allFinite()) throw InputError(name + "the position is not finite");
  if (!edge.information.allFinite())
    throw InputError(name + "the information matrix is not finite");
  if (!edge.information.isApprox(edge.information.transpose(), 1e-9))
    throw InputError(name + "the information matrix is not symmetric");
  const bool valid = graph.space == Space::se2
                         ? is_semidefinite(Eigen::Matrix2d(edge.information.topLeftCorner<2, 2>()))
                         : is_semidefinite(edge.information);
  if (!valid) throw InputError(name + "the information matrix has a negative eigenvalue");
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
  for (size_t k = 0; k < graph.points.size(); ++k)
    if (!graph.points[k].allFinite())
      throw InputError("pose graph point " + std::to_string(k) + ": the position is not finite");
  for (size_t k = 0; k < graph.point_edges.size(); ++k)
    check_point_edge(graph.point_edges[k], k, graph);
}

void check_edges(std::span<const PoseGraphEdge> edges, Space space, size_t num_poses) {
  for (size_t k = 0; k < edges.size(); ++k) check_edge(edges[k], k, space, num_poses);
}

std::vector<int> connected_components(const PoseGraph& graph) {
  // Union by smaller root, so the root of a component is its smallest node.
  std::vector<int> parent(graph.poses.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto join = [&parent](int i, int j) {
    const int a = find_root(parent, i);
    const int b = find_root(parent, j);
    parent[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
  };
  for (const PoseGraphEdge& edge : graph.edges) join(edge.from, edge.to);
  std::vector<int> seen_from(graph.points.size(), -1);
  for (const PointEdge& edge : graph.point_edges) {
    int& first = seen_from[static_cast<size_t>(edge.point)];
    if (first < 0) first = edge.node;
    join(first, edge.node);
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
