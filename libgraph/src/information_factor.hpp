// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <vector>

#include "elimination_layout.hpp"
#include "elimination_tree.hpp"
#include "inverse_columns.hpp"
#include "pose_problem.hpp"
#include "sparse_cholesky.hpp"

namespace hmt::graph {

/// The factor L of the information matrix of all free poses and the points, L L^T = sum of J^T
/// Omega J, and the covariance of linear functions of the poses from it.
template <class Chart>
class InformationFactor {
 public:
  using Matrix = typename Chart::Matrix;

  explicit InformationFactor(const PoseGraph& graph)
      : layout_(elimination_layout(graph, held_nodes(graph))),
        diagonal_once_(graph.poses.size()),
        diagonal_(graph.poses.size()) {
    parameters_.resize(graph.poses.size() * Chart::kParameters);
    for (size_t node = 0; node < graph.poses.size(); ++node)
      Chart::store(graph.poses[node], parameters_.data() + node * Chart::kParameters);
    for (const Eigen::Vector3d& point : graph.points)
      point_parameters_.insert(point_parameters_.end(), point.data(), point.data() + Chart::kPoint);
    information_ = information_matrix(graph);
    factor_ = cholesky_factor(information_);
  }

  bool ok() const { return factor_.has_value(); }

  double condition() const { return condition_number(information_, *factor_); }

  Matrix6d marginal(int node) const {
    std::array<double, Chart::kParameters> world;
    Chart::store(Pose{}, world.data());
    const Pose T_world_node = Chart::load(parameters(node));
    Matrix J_world, J_node;
    Chart::linearize(typename Chart::Measurement(T_world_node), world.data(), parameters(node),
                     J_world, J_node);
    return covariance({{{row(node), J_node}, {-1, J_node}}});
  }

  Matrix6d relative(int a, int b) const {
    const Pose T_a_b = relative_pose(Chart::load(parameters(a)), Chart::load(parameters(b)));
    Matrix J_a, J_b;
    Chart::linearize(typename Chart::Measurement(T_a_b), parameters(a), parameters(b), J_a, J_b);
    if (a == b) return Matrix6d::Zero();
    return covariance({{{row(a), J_a}, {row(b), J_b}}});
  }

  /// Covariance of a point in the frame of a node, or in the world; the point must be measured.
  Eigen::Matrix3d point(std::optional<int> node, int point) const {
    PointByPose J_node = PointByPose::Zero();
    PointMatrix J_point = PointMatrix::Identity();
    if (node) Chart::linearize_point(parameters(*node), point_parameters(point), J_node, J_point);
    Term from_node{node ? row(*node) : -1, Jacobian::Zero(kSize, kSize)};
    from_node.J.template topRows<Chart::kPoint>() = J_node;
    Term from_point{point_row(point), Jacobian::Zero(kSize, Chart::kPoint)};
    from_point.J.template topRows<Chart::kPoint>() = J_point;
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
    covariance.topLeftCorner<Chart::kPoint, Chart::kPoint>() =
        covariance_block({from_node, from_point})
            .template topLeftCorner<Chart::kPoint, Chart::kPoint>();
    return covariance;
  }

  /// The same from blocks of a column of H^-1: slower for one pair, faster for many with the same
  /// `a`.
  Matrix6d relative_by_column(int a, int b) const {
    if (a == b) return Matrix6d::Zero();
    const Pose T_a_b = relative_pose(Chart::load(parameters(a)), Chart::load(parameters(b)));
    Matrix J_a, J_b;
    Chart::linearize(typename Chart::Measurement(T_a_b), parameters(a), parameters(b), J_a, J_b);
    Matrix S_ba = Matrix::Zero();
    if (row(a) >= 0 && row(b) >= 0) S_ba = inverse_.block(*factor_, row(b), row(a));
    const Matrix cross = J_b * S_ba * J_a.transpose();
    const Matrix sum = J_a * diagonal(a) * J_a.transpose() + J_b * diagonal(b) * J_b.transpose() +
                       cross + cross.transpose();
    return from_chart_block<Chart>((sum + sum.transpose()) / 2);
  }

 private:
  static constexpr int kSize = Chart::kTangent;
  using SparseMatrix = Eigen::SparseMatrix<double>;
  using PointMatrix = typename Chart::PointMatrix;
  using PointByPose = typename Chart::PointByPose;
  /// By the steps of a pose or of a point.
  using Jacobian = Eigen::Matrix<double, kSize, Eigen::Dynamic, Eigen::ColMajor, kSize, kSize>;
  struct Term {
    int row;  ///< first row of the unknown; -1: it is held
    Jacobian J;
  };

  int row(int node) const { return layout_.node[static_cast<size_t>(node)]; }
  int point_row(int point) const { return layout_.point[static_cast<size_t>(point)]; }
  const double* point_parameters(int point) const {
    return point_parameters_.data() + static_cast<size_t>(point) * Chart::kPoint;
  }
  const double* parameters(int node) const {
    return parameters_.data() + static_cast<size_t>(node) * Chart::kParameters;
  }

  SparseMatrix information_matrix(const PoseGraph& graph) const {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(graph.edges.size() * kSize * (2 * kSize + 1));
    const auto add = [&entries](int first_row, int first_column, const auto& block) {
      if (first_row < first_column || first_column < 0) return;
      for (int r = 0; r < block.rows(); ++r)
        for (int c = 0; c < block.cols(); ++c)
          if (first_row != first_column || r >= c)
            entries.emplace_back(first_row + r, first_column + c, block(r, c));
    };
    const auto add_factor = [&add](int a, int b, const auto& J_a, const auto& J_b) {
      add(a, a, (J_a.transpose() * J_a).eval());
      add(b, b, (J_b.transpose() * J_b).eval());
      add(a, b, (J_a.transpose() * J_b).eval());
      add(b, a, (J_b.transpose() * J_a).eval());
    };
    for (const PoseGraphEdge& edge : graph.edges) {
      Matrix J_from, J_to;
      EdgeFactor<Chart>(edge).linearize(parameters(edge.from), parameters(edge.to), J_from, J_to);
      add_factor(row(edge.from), row(edge.to), J_from, J_to);
    }
    for (const PointEdge& edge : graph.point_edges) {
      PointByPose J_node;
      PointMatrix J_point;
      PointFactor<Chart>(edge).linearize(parameters(edge.node), point_parameters(edge.point),
                                         J_node, J_point);
      add_factor(row(edge.node), point_row(edge.point), J_node, J_point);
    }
    SparseMatrix information(layout_.size, layout_.size);
    information.setFromTriplets(entries.begin(), entries.end());
    return information;
  }

  /// S = (sum of J E) H^-1 (sum of J E)^T = Y^T Y with L Y = (sum of J E)^T. Y is zero outside the
  /// paths from the terms to the root of the elimination tree, so only these are walked.
  Matrix6d covariance(const std::array<Term, 2>& terms) const {
    return from_chart_block<Chart>(covariance_block(terms));
  }

  Matrix covariance_block(const std::array<Term, 2>& terms) const {
    const SparseMatrix& L = *factor_;
    ColumnsOf<kSize>& y = workspace_.local();
    if (y.rows() != L.rows()) y.setZero(L.rows(), kSize);
    const std::vector<int> path = union_of_paths(terms, L);
    for (const Term& term : terms)
      if (term.row >= 0) y.middleRows(term.row, term.J.cols()) += term.J.transpose();
    Eigen::Matrix<double, kSize, kSize> sum = Eigen::Matrix<double, kSize, kSize>::Zero();
    for (const int j : path) {
      const RowOf<kSize> y_j = eliminate<kSize>(L, j, y);
      sum += y_j.transpose() * y_j;
      y.row(j).setZero();
    }
    return sum;
  }

  /// Covariance of a pose alone, in its tangent; found once.
  const Matrix& diagonal(int node) const {
    const auto i = static_cast<size_t>(node);
    std::call_once(diagonal_once_[i], [this, i] {
      diagonal_[i] =
          covariance_block({{{layout_.node[i], Matrix::Identity()}, {-1, Matrix::Identity()}}});
    });
    return diagonal_[i];
  }

  /// Ascending union of the paths.
  static std::vector<int> union_of_paths(const std::array<Term, 2>& terms, const SparseMatrix& L) {
    std::vector<int> path;
    for (const Term& term : terms) {
      if (term.row < 0) continue;
      const auto middle = static_cast<std::ptrdiff_t>(path.size());
      append_path(L, term.row, static_cast<int>(term.J.cols()), path);
      std::inplace_merge(path.begin(), path.begin() + middle, path.end());
    }
    path.erase(std::unique(path.begin(), path.end()), path.end());
    return path;
  }

  EliminationLayout layout_;
  std::vector<double> parameters_;
  std::vector<double> point_parameters_;
  SparseMatrix information_;                           ///< lower triangle
  std::optional<SparseMatrix> factor_;                 ///< nothing where singular
  mutable std::vector<std::once_flag> diagonal_once_;  ///< one a node, as diagonal_
  mutable std::vector<Matrix> diagonal_;
  InverseColumns<kSize> inverse_;
  /// All zero between calls.
  mutable tbb::enumerable_thread_specific<ColumnsOf<kSize>> workspace_;
};

}  // namespace hmt::graph
