// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/point_information_loss.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <string>

#include "hmt/graph/input_error.hpp"
#include "pose_problem.hpp"

namespace hmt::graph {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

bool have_common(const std::vector<int>& a, const std::vector<int>& b) {
  return std::any_of(a.begin(), a.end(),
                     [&b](int group) { return std::binary_search(b.begin(), b.end(), group); });
}

/// The information matrix in parts: of the poses, of poses and points, and the diagonal of the
/// points.
template <class Chart>
class PartedInformation {
 public:
  static constexpr int kPose = Chart::kTangent;
  static constexpr int kPoint = Chart::kPoint;
  using PointBlock = Eigen::Matrix<double, kPoint, kPoint>;

  explicit PartedInformation(const PoseGraph& graph)
      : row_(graph.poses.size(), -1),
        points_(graph.points.size(), PointBlock::Zero()),
        measured_(graph.points.size(), false) {
    const std::vector<bool> held = held_nodes(graph);
    int rows = 0;
    for (size_t node = 0; node < held.size(); ++node)
      if (!held[node]) row_[node] = kPose * rows++;
    store(graph);
    for (const PoseGraphEdge& edge : graph.edges) add(edge);
    for (const PointEdge& edge : graph.point_edges) add(edge);
    poses_.resize(kPose * rows, kPose * rows);
    poses_.setFromTriplets(pose_entries_.begin(), pose_entries_.end());
    cross_.resize(kPose * rows, kPoint * static_cast<int>(graph.points.size()));
    cross_.setFromTriplets(cross_entries_.begin(), cross_entries_.end());
  }

  /// Calls visit(i, j, norm) for all measured points i <= j; norm: |H_ij| + |H_ji|, or |H_ii|.
  template <class Visit>
  void for_each_block(const Visit& visit) const {
    const Eigen::SimplicialLLT<SparseMatrix> factor(poses_);
    if (factor.info() != Eigen::Success) return;
    for (size_t i = 0; i < points_.size(); ++i) {
      if (!measured_[i]) continue;
      const auto column = static_cast<Eigen::Index>(i) * kPoint;
      const Eigen::MatrixXd own = cross_.middleCols(column, kPoint);
      const Eigen::MatrixXd solved = factor.solve(own);
      for (size_t j = i; j < points_.size(); ++j) {
        if (!measured_[j]) continue;
        PointBlock block = -(
            cross_.middleCols(static_cast<Eigen::Index>(j) * kPoint, kPoint).transpose() * solved);
        if (i == j) block += points_[i];
        visit(i, j, block.norm() * (i == j ? 1 : 2));
      }
    }
  }

 private:
  void store(const PoseGraph& graph) {
    poses_at_.resize(graph.poses.size() * Chart::kParameters);
    for (size_t node = 0; node < graph.poses.size(); ++node)
      Chart::store(graph.poses[node], poses_at_.data() + node * Chart::kParameters);
    for (const Eigen::Vector3d& point : graph.points)
      points_at_.insert(points_at_.end(), point.data(), point.data() + kPoint);
  }

  const double* pose_at(int node) const {
    return poses_at_.data() + static_cast<size_t>(node) * Chart::kParameters;
  }

  void add_to_poses(int row, int column, const Eigen::Matrix<double, kPose, kPose>& block) {
    for (int r = 0; row >= 0 && column >= 0 && r < kPose; ++r)
      for (int c = 0; c < kPose; ++c) pose_entries_.emplace_back(row + r, column + c, block(r, c));
  }

  void add(const PoseGraphEdge& edge) {
    typename Chart::Matrix J_from, J_to;
    EdgeFactor<Chart>(edge).linearize(pose_at(edge.from), pose_at(edge.to), J_from, J_to);
    const int from = row_[static_cast<size_t>(edge.from)];
    const int to = row_[static_cast<size_t>(edge.to)];
    add_to_poses(from, from, J_from.transpose() * J_from);
    add_to_poses(to, to, J_to.transpose() * J_to);
    add_to_poses(from, to, J_from.transpose() * J_to);
    add_to_poses(to, from, J_to.transpose() * J_from);
  }

  void add(const PointEdge& edge) {
    typename Chart::PointByPose J_node;
    typename Chart::PointMatrix J_point;
    const auto point = static_cast<size_t>(edge.point);
    PointFactor<Chart>(edge).linearize(pose_at(edge.node), points_at_.data() + point * kPoint,
                                       J_node, J_point);
    points_[point] += J_point.transpose() * J_point;
    measured_[point] = true;
    const int row = row_[static_cast<size_t>(edge.node)];
    add_to_poses(row, row, J_node.transpose() * J_node);
    const Eigen::Matrix<double, kPose, kPoint> block = J_node.transpose() * J_point;
    for (int r = 0; row >= 0 && r < kPose; ++r)
      for (int c = 0; c < kPoint; ++c)
        cross_entries_.emplace_back(row + r, kPoint * edge.point + c, block(r, c));
  }

  std::vector<int> row_;  ///< first row of each node; -1: it is held
  std::vector<double> poses_at_;
  std::vector<double> points_at_;
  std::vector<PointBlock> points_;
  std::vector<bool> measured_;
  std::vector<Eigen::Triplet<double>> pose_entries_;
  std::vector<Eigen::Triplet<double>> cross_entries_;
  SparseMatrix poses_;
  SparseMatrix cross_;
};

/// Sums up e of Eq. 22.
class LossSum {
 public:
  LossSum(std::span<const std::vector<int>> groups, size_t num_points) : groups_(groups) {
    if (groups.size() != num_points)
      throw InputError("information loss: groups of " + std::to_string(groups.size()) +
                       " points for " + std::to_string(num_points));
  }

  void add(size_t i, size_t j, double norm) {
    all_ += norm;
    if (!have_common(groups_[i], groups_[j])) between_ += norm;
  }
  double ratio() const { return all_ > 0 ? between_ / all_ : 0; }

 private:
  std::span<const std::vector<int>> groups_;
  double all_ = 0;
  double between_ = 0;
};

}  // namespace

PointInformationBlocks::PointInformationBlocks(const PoseGraph& graph)
    : num_points_(graph.points.size()) {
  check_pose_graph(graph);
  with_chart(graph.space, [&](auto chart) {
    PartedInformation<decltype(chart)>(graph).for_each_block(
        [this](size_t i, size_t j, double norm) {
          blocks_.push_back({i, j, norm});
        });
  });
}

double PointInformationBlocks::loss(std::span<const std::vector<int>> groups_of_point) const {
  LossSum sum(groups_of_point, num_points_);
  for (const Block& block : blocks_) sum.add(block.i, block.j, block.norm);
  return sum.ratio();
}

double point_information_loss(const PoseGraph& graph,
                              std::span<const std::vector<int>> groups_of_point) {
  LossSum sum(groups_of_point, graph.points.size());
  check_pose_graph(graph);
  with_chart(graph.space, [&](auto chart) {
    PartedInformation<decltype(chart)>(graph).for_each_block(
        [&sum](size_t i, size_t j, double norm) { sum.add(i, j, norm); });
  });
  return sum.ratio();
}

}  // namespace hmt::graph
