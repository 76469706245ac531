// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pose_covariance.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <string>
#include <variant>

#include "elimination_layout.hpp"
#include "hmt/graph/input_error.hpp"
#include "pose_problem.hpp"
#include "sparse_cholesky.hpp"

namespace hmt::graph {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

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
    if (row(a) >= 0 && row(b) >= 0) S_ba = inverse_block(b, a);
    const Matrix cross = J_b * S_ba * J_a.transpose();
    const Matrix sum = J_a * diagonal(a) * J_a.transpose() + J_b * diagonal(b) * J_b.transpose() +
                       cross + cross.transpose();
    return from_chart_block<Chart>((sum + sum.transpose()) / 2);
  }

 private:
  static constexpr int kSize = Chart::kTangent;
  using Row = Eigen::Matrix<double, 1, kSize>;
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, kSize, Eigen::RowMajor>;
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
    Columns& y = workspace_.local();
    if (y.rows() != L.rows()) y.setZero(L.rows(), kSize);
    const std::vector<int> path = union_of_paths(terms, L);
    for (const Term& term : terms)
      if (term.row >= 0) y.middleRows(term.row, term.J.cols()) += term.J.transpose();
    Eigen::Matrix<double, kSize, kSize> sum = Eigen::Matrix<double, kSize, kSize>::Zero();
    for (const int j : path) {
      const Row y_j = eliminate(L, j, y);
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

  /// Columns of H^-1 for one pose, as far as they were asked for.
  struct ColumnOfPose {
    int node = -1;
    Columns values;             ///< on the way L^-1 E, in the end L^-T L^-1 E; zero elsewhere
    std::vector<char> is_done;  ///< one a row
    std::vector<int> touched;   ///< rows that are not zero or done
  };

  /// Block (b, a) of H^-1. The thread keeps the columns of `a` until it asks for those of another
  /// pose: back substitution needs of the rows only those from b up to the root of the elimination
  /// tree, most of which the last b has in common with this one.
  Matrix inverse_block(int b, int a) const {
    ColumnOfPose& column = column_.local();
    if (column.node != a) start_column(a, column);
    const SparseMatrix& L = *factor_;
    const int first = row(b);
    std::vector<int>& path = path_.local();
    path.clear();
    for (int k = first; k < first + kSize; ++k)
      for (int j = k; j >= 0 && column.is_done[static_cast<size_t>(j)] == 0; j = parent(L, j)) {
        column.is_done[static_cast<size_t>(j)] = 1;
        path.push_back(j);
      }
    // Ascending within each stretch, and each stretch ends where one before it went on.
    std::sort(path.begin(), path.end());
    for (auto j = path.rbegin(); j != path.rend(); ++j) back_substitute(L, *j, column.values);
    column.touched.insert(column.touched.end(), path.begin(), path.end());
    return column.values.template middleRows<kSize>(first);
  }

  /// L^-1 times the unit columns of a pose.
  void start_column(int a, ColumnOfPose& column) const {
    const SparseMatrix& L = *factor_;
    if (column.values.rows() != L.rows()) {
      column.values.setZero(L.rows(), kSize);
      column.is_done.assign(static_cast<size_t>(L.rows()), 0);
    }
    for (const int j : column.touched) {
      column.values.row(j).setZero();
      column.is_done[static_cast<size_t>(j)] = 0;
    }
    column.node = a;
    const Term whole{row(a), Matrix::Identity()};
    column.touched = union_of_paths({whole, {-1, Matrix::Identity()}}, L);
    column.values.template middleRows<kSize>(row(a)).setIdentity();
    for (const int j : column.touched) column.values.row(j) = eliminate(L, j, column.values);
  }

  /// x_j of L x = y, y in `values`, taken out of the rows below.
  static Row eliminate(const SparseMatrix& L, int j, Columns& values) {
    int entry = L.outerIndexPtr()[j];
    const Row x_j = values.row(j) / L.valuePtr()[entry];
    for (++entry; entry < L.outerIndexPtr()[j + 1]; ++entry)
      values.row(L.innerIndexPtr()[entry]) -= L.valuePtr()[entry] * x_j;
    return x_j;
  }

  /// x_j of L^T x = y in place, the rows below being solved.
  static void back_substitute(const SparseMatrix& L, int j, Columns& values) {
    const int diagonal = L.outerIndexPtr()[j];
    Row x_j = values.row(j);
    for (int entry = diagonal + 1; entry < L.outerIndexPtr()[j + 1]; ++entry)
      x_j -= L.valuePtr()[entry] * values.row(L.innerIndexPtr()[entry]);
    values.row(j) = x_j / L.valuePtr()[diagonal];
  }

  /// Of a column in the elimination tree: its first entry below the diagonal; -1 for a root.
  static int parent(const SparseMatrix& L, int j) {
    const int entry = L.outerIndexPtr()[j] + 1;
    return entry < L.outerIndexPtr()[j + 1] ? L.innerIndexPtr()[entry] : -1;
  }

  /// Ascending union of the paths.
  static std::vector<int> union_of_paths(const std::array<Term, 2>& terms, const SparseMatrix& L) {
    std::vector<int> path;
    for (const Term& term : terms) {
      if (term.row < 0) continue;
      const auto middle = static_cast<std::ptrdiff_t>(path.size());
      for (int k = 0; k < term.J.cols(); ++k) path.push_back(term.row + k);
      for (int j = parent(L, path.back()); j >= 0; j = parent(L, j)) path.push_back(j);
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
  mutable tbb::enumerable_thread_specific<ColumnOfPose> column_;
  mutable tbb::enumerable_thread_specific<std::vector<int>> path_;
  /// All zero between calls.
  mutable tbb::enumerable_thread_specific<Columns> workspace_;
};

}  // namespace

struct PoseCovariance::Impl {
  explicit Impl(const PoseGraph& graph)
      : component(connected_components(graph)), node_of_point(graph.points.size(), -1) {
    for (const PointEdge& edge : graph.point_edges)
      node_of_point[static_cast<size_t>(edge.point)] = edge.node;
    if (graph.space == Space::se2)
      factor.emplace<InformationFactor<PlanarChart>>(graph);
    else
      factor.emplace<InformationFactor<SpatialChart>>(graph);
    anchored.assign(graph.poses.size(), false);
    for (const int node : graph.fixed)
      anchored[static_cast<size_t>(component[static_cast<size_t>(node)])] = true;
  }

  void check(int node) const {
    if (node < 0 || static_cast<size_t>(node) >= component.size())
      throw InputError("covariance of node " + std::to_string(node) + ": the graph has " +
                       std::to_string(component.size()) + " nodes");
  }

  void check_point(int point) const {
    if (point < 0 || static_cast<size_t>(point) >= node_of_point.size())
      throw InputError("covariance of point " + std::to_string(point) + ": the graph has " +
                       std::to_string(node_of_point.size()) + " points");
  }

  /// The gauge says nothing about two components that nobody fixed.
  bool related(int a, int b) const {
    const auto own_a = static_cast<size_t>(component[static_cast<size_t>(a)]);
    const auto own_b = static_cast<size_t>(component[static_cast<size_t>(b)]);
    return own_a == own_b || (anchored[own_a] && anchored[own_b]);
  }

  std::vector<int> component;
  std::vector<int> node_of_point;  ///< one that measures it; -1: none
  std::vector<bool> anchored;
  std::variant<std::monostate, InformationFactor<PlanarChart>, InformationFactor<SpatialChart>>
      factor;
};

namespace {

/// Calls `function` with the factor that the variant holds.
template <class Variant, class Function>
auto visit_factor(const Variant& factor, const Function& function) {
  return factor.index() == 1 ? function(std::get<1>(factor)) : function(std::get<2>(factor));
}

}  // namespace

PoseCovariance::PoseCovariance(const PoseGraph& graph) {
  check_pose_graph(graph);
  impl_ = std::make_unique<Impl>(graph);
}
PoseCovariance::~PoseCovariance() = default;
PoseCovariance::PoseCovariance(PoseCovariance&&) noexcept = default;
PoseCovariance& PoseCovariance::operator=(PoseCovariance&&) noexcept = default;

bool PoseCovariance::ok() const {
  return visit_factor(impl_->factor, [](const auto& factor) { return factor.ok(); });
}

std::optional<double> PoseCovariance::condition() const {
  if (!ok()) return std::nullopt;
  return visit_factor(impl_->factor, [](const auto& factor) { return factor.condition(); });
}

std::optional<Matrix6d> PoseCovariance::marginal(int node) const {
  impl_->check(node);
  if (!ok()) return std::nullopt;
  return visit_factor(impl_->factor, [&](const auto& factor) { return factor.marginal(node); });
}

std::optional<Matrix6d> PoseCovariance::relative(int a, int b) const {
  impl_->check(a);
  impl_->check(b);
  if (!ok() || !impl_->related(a, b)) return std::nullopt;
  return visit_factor(impl_->factor, [&](const auto& factor) { return factor.relative(a, b); });
}

std::optional<Matrix6d> PoseCovariance::relative_by_column(int a, int b) const {
  impl_->check(a);
  impl_->check(b);
  if (!ok() || !impl_->related(a, b)) return std::nullopt;
  return visit_factor(impl_->factor,
                      [&](const auto& factor) { return factor.relative_by_column(a, b); });
}

std::optional<Eigen::Matrix3d> PoseCovariance::marginal_point(int point) const {
  impl_->check_point(point);
  if (!ok() || impl_->node_of_point[static_cast<size_t>(point)] < 0) return std::nullopt;
  return visit_factor(impl_->factor,
                      [&](const auto& factor) { return factor.point(std::nullopt, point); });
}

std::optional<Eigen::Matrix3d> PoseCovariance::relative_point(int node, int point) const {
  impl_->check(node);
  impl_->check_point(point);
  const int seen_from = impl_->node_of_point[static_cast<size_t>(point)];
  if (!ok() || seen_from < 0 || !impl_->related(node, seen_from)) return std::nullopt;
  return visit_factor(impl_->factor, [&](const auto& factor) { return factor.point(node, point); });
}

std::vector<std::optional<Matrix6d>> PoseCovariance::relative(
    std::span<const std::pair<int, int>> pairs, int threads) const {
  std::vector<std::optional<Matrix6d>> covariances(pairs.size());
  tbb::task_arena(std::max(1, threads)).execute([&] {
    tbb::parallel_for(size_t{0}, pairs.size(), [&](size_t k) {
      covariances[k] = relative(pairs[k].first, pairs[k].second);
    });
  });
  return covariances;
}

}  // namespace hmt::graph
