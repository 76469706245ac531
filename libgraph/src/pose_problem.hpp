// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hmt/graph/pose_graph.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "pose_factor.hpp"

namespace hmt::graph {

/// Throws InputError naming the first edge, pose or fixed node whose numbers are invalid: a node
/// outside the graph, an edge from a node to itself, a number that is not finite, an information
/// matrix that is not symmetric or has a negative eigenvalue beyond rounding.
void check_pose_graph(const PoseGraph& graph);

/// The same for edges alone, whose nodes must lie in [0, num_poses).
void check_edges(std::span<const PoseGraphEdge> edges, Space space, size_t num_poses);

/// Component of each node, numbered by smallest node.
std::vector<int> connected_components(const PoseGraph& graph);

/// One flag a node: held at its pose. The fixed nodes of the graph, and the smallest node of each
/// component that has none.
std::vector<bool> held_nodes(const PoseGraph& graph);

/// Where the poses of the nodes are and the points with them.
struct Placement {
  std::vector<Pose> poses;
  std::vector<Eigen::Vector3d> points;
};

/// r^T Omega r of every factor at a placement: the edges, then the point edges.
std::vector<double> factor_chi2(const PoseGraph& graph, const Placement& placement);

/// What one call of the solver did.
struct SolveReport {
  Termination termination = Termination::nothing_to_do;
  std::string message;
  int iterations = 0;
  double gradient_norm = 0;
  std::vector<bool> inlier;  ///< empty: all
  double cost = 0;           ///< see PoseOptimizerReport
  bool untrusted_start = false;
};

/// A pose graph as the solver sees it: parameters of every pose and point, and a factor for every
/// edge, then for every point edge. The graph must outlive it.
template <class Chart>
class PoseProblem {
 public:
  explicit PoseProblem(const PoseGraph& graph);

  /// Minimizes the sum over factors of weight * rho(r^T Omega r) from the present placement; rho is
  /// the identity or, with `huber`, linear in r beyond the 95 % quantile of chi2. A factor of
  /// weight zero is left out.
  SolveReport solve(const std::vector<double>& weights, bool huber, int max_iterations);

  void set_placement(const Placement& placement);
  /// The present poses; held nodes come back exactly as given.
  std::vector<Pose> poses() const;
  Placement placement() const { return {poses(), points()}; }
  /// r^T Omega r of every factor at the present placement.
  std::vector<double> factor_chi2() const;

 private:
  struct Costs;

  std::vector<Eigen::Vector3d> points() const;
  const double* parameters(int node) const {
    return parameters_.data() + static_cast<size_t>(node) * Chart::kParameters;
  }
  const double* point_parameters(int point) const {
    return point_parameters_.data() + static_cast<size_t>(point) * Chart::kPoint;
  }

  const PoseGraph* graph_;
  std::vector<bool> held_;
  // Shared by the copies of a problem, which differ in their placement alone.
  std::shared_ptr<const std::vector<EdgeFactor<Chart>>> factors_;
  std::shared_ptr<const std::vector<PointFactor<Chart>>> point_factors_;
  std::vector<double> parameters_;
  std::vector<double> point_parameters_;
};

extern template class PoseProblem<PlanarChart>;
extern template class PoseProblem<SpatialChart>;

}  // namespace hmt::graph
