// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pose_problem.hpp"

#include <ceres/cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>

#include <cmath>
#include <deque>

#include "minimizer.hpp"

namespace hmt::graph {
namespace {

/// Ceres sees an edge through this: residual W r * sqrt(weight). The derivatives by the steps stand
/// in the first columns of Ceres' derivatives by the parameters; the manifold below says so.
template <class Chart>
class EdgeCost final
    : public ceres::SizedCostFunction<Chart::kTangent, Chart::kParameters, Chart::kParameters> {
 public:
  EdgeCost(const EdgeFactor<Chart>& factor, double weight)
      : factor_(&factor), scale_(std::sqrt(weight)) {}

  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override {
    using Vector = typename EdgeFactor<Chart>::Vector;
    Eigen::Map<Vector> r(residuals);
    if (jacobians == nullptr) {
      r = scale_ * factor_->error(poses[0], poses[1]);
      return true;
    }
    typename EdgeFactor<Chart>::Matrix J_from, J_to;
    r = scale_ * factor_->linearize(poses[0], poses[1], J_from, J_to);
    if (jacobians[0] != nullptr) write(J_from, jacobians[0]);
    if (jacobians[1] != nullptr) write(J_to, jacobians[1]);
    return true;
  }

 private:
  void write(const typename EdgeFactor<Chart>::Matrix& J, double* jacobian) const {
    using Full = Eigen::Matrix<double, Chart::kTangent, Chart::kParameters, Eigen::RowMajor>;
    Eigen::Map<Full> full(jacobian);
    full.template leftCols<Chart::kTangent>() = scale_ * J;
    full.template rightCols<Chart::kParameters - Chart::kTangent>().setZero();
  }

  const EdgeFactor<Chart>* factor_;
  double scale_;
};

/// The steps of SpatialChart. Ceres uses derivatives by the seven parameters only in their product
/// with PlusJacobian, so both may be given in any coordinates that make this product right: here
/// the steps themselves, which spares the detour over the quaternion's numbers.
class SpatialManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return SpatialChart::kParameters; }
  int TangentSize() const override { return SpatialChart::kTangent; }

  bool Plus(const double* x, const double* step, double* moved) const override {
    Vector6d tangent = Eigen::Map<const Vector6d>(step);
    const Pose T = SpatialChart::load(x);
    tangent.head<3>() = T.rotation.conjugate() * tangent.head<3>();
    SpatialChart::store(boxplus(T, tangent), moved);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* step) const override {
    const Pose T = SpatialChart::load(x);
    Eigen::Map<Vector6d> tangent(step);
    tangent = boxminus(SpatialChart::load(y), T);
    tangent.head<3>() = T.rotation * tangent.head<3>();
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>>(jacobian).setIdentity();
    return true;
  }
};

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.disable_all_safety_checks = true;
  return options;
}

}  // namespace

template <class Chart>
PoseProblem<Chart>::PoseProblem(const PoseGraph& graph)
    : graph_(&graph),
      held_(held_nodes(graph)),
      factors_(std::make_shared<std::vector<EdgeFactor<Chart>>>(graph.edges.begin(),
                                                                graph.edges.end())) {
  set_poses(graph.poses);
}

template <class Chart>
void PoseProblem<Chart>::set_poses(const std::vector<Pose>& poses) {
  parameters_.resize(poses.size() * Chart::kParameters);
  for (size_t node = 0; node < poses.size(); ++node)
    Chart::store(poses[node], parameters_.data() + node * Chart::kParameters);
}

template <class Chart>
std::vector<Pose> PoseProblem<Chart>::poses() const {
  std::vector<Pose> poses(graph_->poses.size());
  for (size_t node = 0; node < poses.size(); ++node)
    poses[node] =
        held_[node] ? graph_->poses[node] : Chart::load(parameters(static_cast<int>(node)));
  return poses;
}

template <class Chart>
std::vector<double> PoseProblem<Chart>::edge_chi2() const {
  std::vector<double> chi2(factors_->size());
  for (size_t k = 0; k < factors_->size(); ++k)
    chi2[k] =
        (*factors_)[k].chi2(parameters(graph_->edges[k].from), parameters(graph_->edges[k].to));
  return chi2;
}

template <class Chart>
SolveReport PoseProblem<Chart>::solve(const std::vector<double>& edge_weights, double huber_chi2,
                                      int max_iterations) {
  SpatialManifold manifold;
  ceres::HuberLoss huber(huber_chi2 > 0 ? std::sqrt(huber_chi2) : 1.0);
  std::deque<EdgeCost<Chart>> costs;
  ceres::Problem problem(problem_options());
  const auto block = [this](int node) {
    return parameters_.data() + static_cast<size_t>(node) * Chart::kParameters;
  };
  for (size_t k = 0; k < factors_->size(); ++k) {
    const PoseGraphEdge& edge = graph_->edges[k];
    const bool both_held =
        held_[static_cast<size_t>(edge.from)] && held_[static_cast<size_t>(edge.to)];
    if (edge_weights[k] <= 0 || both_held) continue;
    costs.emplace_back((*factors_)[k], edge_weights[k]);
    problem.AddResidualBlock(&costs.back(), huber_chi2 > 0 ? &huber : nullptr, block(edge.from),
                             block(edge.to));
  }
  if (costs.empty()) return {};
  for (size_t node = 0; node < held_.size(); ++node) {
    double* const pose = block(static_cast<int>(node));
    if (!problem.HasParameterBlock(pose)) continue;
    if constexpr (Chart::kParameters != Chart::kTangent) problem.SetManifold(pose, &manifold);
    if (held_[node]) problem.SetParameterBlockConstant(pose);
  }
  const MinimizerReport minimized = minimize(problem, max_iterations);
  SolveReport report;
  report.termination = minimized.termination;
  report.message = minimized.message;
  report.iterations = minimized.iterations;
  report.gradient_norm = minimized.gradient_norm;
  report.cost = minimized.cost;
  return report;
}

std::vector<double> edge_chi2(const PoseGraph& graph, const std::vector<Pose>& poses) {
  return with_chart(graph.space, [&](auto chart) {
    PoseProblem<decltype(chart)> problem(graph);
    problem.set_poses(poses);
    return problem.edge_chi2();
  });
}

template class PoseProblem<PlanarChart>;
template class PoseProblem<SpatialChart>;

}  // namespace hmt::graph
