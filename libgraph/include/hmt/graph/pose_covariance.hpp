// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// Marginal covariances of a pose graph at its poses and points, from the sparse factor of its
/// information matrix. In Space::se2 the rows of z, rx and ry are zero.
class PoseCovariance {
 public:
  /// Factorizes the information matrix (Gauss-Newton, gauge of PoseGraph::fixed).
  explicit PoseCovariance(const PoseGraph& graph);
  ~PoseCovariance();
  PoseCovariance(PoseCovariance&&) noexcept;
  PoseCovariance& operator=(PoseCovariance&&) noexcept;

  /// False where the information matrix is singular beyond the gauge; the getters then return
  /// nothing.
  bool ok() const;

  /// Condition number of the information matrix (largest by smallest eigenvalue, metres and radians
  /// as they are), estimated from below by power iteration; 1 where no node is free.
  std::optional<double> condition() const;

  /// Covariance of T_world_node in the tangent of Pose (frame of the node); zero for a fixed node.
  std::optional<Matrix6d> marginal(int node) const;
  /// Covariance of T_a_b in the tangent of Pose (frame b).
  std::optional<Matrix6d> relative(int a, int b) const;
  /// The same, equal up to rounding, from a column of the inverse that each thread keeps for the
  /// last `a`, as far as it was needed: the faster way to many pairs when those of one `a` are
  /// asked for in a row.
  std::optional<Matrix6d> relative_by_column(int a, int b) const;
  /// Covariance of a point in the world; its row of z is zero in Space::se2. Nothing for a point
  /// that no edge measures.
  std::optional<Eigen::Matrix3d> marginal_point(int point) const;
  /// Covariance of a point in the frame of a node.
  std::optional<Eigen::Matrix3d> relative_point(int node, int point) const;
  /// The relative covariances of many pairs; one slot a pair, independent of the number of threads.
  std::vector<std::optional<Matrix6d>> relative(std::span<const std::pair<int, int>> pairs,
                                                int threads) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hmt::graph
