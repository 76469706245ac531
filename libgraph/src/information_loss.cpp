// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/information_loss.hpp"

#include <algorithm>
#include <string>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

/// Rows and columns that the space does not have are cleared.
Matrix6d masked(const Matrix6d& information, Space space) {
  if (space == Space::se3) return information;
  Vector6d keep;
  keep << 1, 1, 0, 0, 0, 1;
  return keep.asDiagonal() * information * keep.asDiagonal();
}

using Blocks = std::map<std::pair<int, int>, Matrix6d>;

/// Upper triangle of H in blocks, the Jacobians taken at residual zero: dr/dfrom = -Ad(T_to_from),
/// dr/dto = I.
Blocks information_blocks(const PoseGraph& graph) {
  Blocks blocks;
  const auto add = [&blocks](int i, int j, const Matrix6d& block) {
    const auto [at, is_new] = blocks.try_emplace({i, j}, block);
    if (!is_new) at->second += block;
  };
  for (const PoseGraphEdge& edge : graph.edges) {
    const Matrix6d omega = masked(edge.information, graph.space);
    const Pose T_from_to = relative_pose(graph.poses.at(static_cast<size_t>(edge.from)),
                                         graph.poses.at(static_cast<size_t>(edge.to)));
    const Matrix6d J_from = -adjoint(T_from_to.inverse());
    add(edge.from, edge.from, J_from.transpose() * omega * J_from);
    add(edge.to, edge.to, omega);
    const Matrix6d off = J_from.transpose() * omega;
    if (edge.from < edge.to) add(edge.from, edge.to, off);
    if (edge.from > edge.to) add(edge.to, edge.from, off.transpose());
  }
  return blocks;
}

}  // namespace

InformationBlocks::InformationBlocks(const PoseGraph& graph) : num_nodes_(graph.poses.size()) {
  for (const auto& [nodes, block] : information_blocks(graph)) {
    const auto [i, j] = nodes;
    const double norm = block.norm() * (i == j ? 1 : 2);
    all_ += norm;
    if (i != j) off_diagonal_.push_back({i, j, norm});
  }
}

InformationLoss InformationBlocks::loss(std::span<const int> labels) const {
  if (labels.size() != num_nodes_)
    throw InputError("information loss: " + std::to_string(labels.size()) + " labels for " +
                     std::to_string(num_nodes_) + " poses");
  InformationLoss loss;
  if (all_ <= 0) return loss;
  for (const Block& block : off_diagonal_) {
    const int a = labels[static_cast<size_t>(block.i)];
    const int b = labels[static_cast<size_t>(block.j)];
    if (a != b) loss.between[std::minmax(a, b)] += block.norm;
  }
  for (auto& [groups, norm] : loss.between) {
    norm /= all_;
    loss.total += norm;
  }
  return loss;
}

InformationLoss information_loss(const PoseGraph& graph, std::span<const int> labels) {
  return InformationBlocks(graph).loss(labels);
}

}  // namespace hmt::graph
