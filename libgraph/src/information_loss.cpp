// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/information_loss.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <map>
#include <string>
#include <vector>

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

/// Upper triangle of H in blocks.
class Blocks {
 public:
  void add(int i, int j, const Matrix6d& block) {
    if (i > j) return;
    const auto [at, is_new] = blocks_.try_emplace({i, j}, block);
    if (!is_new) at->second += block;
  }
  const std::map<std::pair<int, int>, Matrix6d>& all() const { return blocks_; }

 private:
  std::map<std::pair<int, int>, Matrix6d> blocks_;
};

/// The Jacobians are taken at residual zero: dr/dfrom = -Ad(T_to_from), dr/dto = I.
void add_edges(const PoseGraph& graph, Blocks& blocks) {
  for (const PoseGraphEdge& edge : graph.edges) {
    const Matrix6d omega = masked(edge.information, graph.space);
    const Pose T_from_to = relative_pose(graph.poses.at(static_cast<size_t>(edge.from)),
                                         graph.poses.at(static_cast<size_t>(edge.to)));
    const Matrix6d J_from = -adjoint(T_from_to.inverse());
    const Matrix6d off = J_from.transpose() * omega;
    blocks.add(edge.from, edge.from, J_from.transpose() * omega * J_from);
    blocks.add(edge.to, edge.to, omega);
    blocks.add(edge.from, edge.to, off);
    blocks.add(edge.to, edge.from, off.transpose());
  }
}

/// What the sightings of one point tell of a pose: their blocks of H.
struct PointBlocks {
  int node = 0;
  Matrix6d own = Matrix6d::Zero();                                          ///< H_pp
  Eigen::Matrix<double, 6, 3> cross = Eigen::Matrix<double, 6, 3>::Zero();  ///< H_pl
};

/// Blocks of one sighting, the point where it was measured: dr/dnode = (-I, [p]x), dr/dpoint = R^T.
PointBlocks point_blocks(const PointEdge& edge, const PoseGraph& graph, Eigen::Matrix3d& H_ll) {
  Eigen::Matrix3d omega = edge.information;
  Eigen::Vector3d p = edge.p_node;
  if (graph.space == Space::se2) {
    omega.row(2).setZero();
    omega.col(2).setZero();
    p.z() = 0;
  }
  const Eigen::Matrix3d J_point =
      graph.poses.at(static_cast<size_t>(edge.node)).rotation_matrix().transpose();
  Eigen::Matrix<double, 3, 6> J_node;
  J_node << -Eigen::Matrix3d::Identity(), skew(p);
  H_ll += J_point.transpose() * omega * J_point;
  return {edge.node, J_node.transpose() * omega * J_node, J_node.transpose() * omega * J_point};
}

/// All poses that sighted a point, the point marginalized out: H_ij - H_il H_ll^-1 H_lj.
void add_points(const PoseGraph& graph, Blocks& blocks) {
  std::vector<std::vector<PointBlocks>> by_point(graph.points.size());
  std::vector<Eigen::Matrix3d> H_ll(graph.points.size(), Eigen::Matrix3d::Zero());
  for (const PointEdge& edge : graph.point_edges) {
    const auto point = static_cast<size_t>(edge.point);
    by_point.at(point).push_back(point_blocks(edge, graph, H_ll[point]));
  }
  for (size_t point = 0; point < by_point.size(); ++point) {
    const Eigen::Matrix3d inverse = H_ll[point].completeOrthogonalDecomposition().pseudoInverse();
    for (const PointBlocks& a : by_point[point]) {
      blocks.add(a.node, a.node, a.own);
      const Eigen::Matrix<double, 6, 3> gain = a.cross * inverse;
      for (const PointBlocks& b : by_point[point])
        blocks.add(a.node, b.node, -gain * b.cross.transpose());
    }
  }
}

}  // namespace

InformationBlocks::InformationBlocks(const PoseGraph& graph) : num_nodes_(graph.poses.size()) {
  Blocks blocks;
  add_edges(graph, blocks);
  add_points(graph, blocks);
  for (const auto& [nodes, block] : blocks.all()) {
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
