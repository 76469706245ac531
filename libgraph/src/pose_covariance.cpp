// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pose_covariance.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <string>
#include <variant>

#include "hmt/graph/input_error.hpp"
#include "information_factor.hpp"

namespace hmt::graph {

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
