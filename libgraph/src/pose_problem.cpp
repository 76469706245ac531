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

#include "hmt/graph/chi_squared.hpp"
#include "minimizer.hpp"

namespace hmt::graph {
namespace {

/// Errors beyond this quantile of chi2 count linearly with the Huber loss.
constexpr double kHuberProbability = 0.95;

/// Ceres sees a factor through this: residual W r * sqrt(weight) of a pose and another pose or
/// point. The derivatives by the steps stand in the first columns of Ceres' derivatives by the
/// parameters; the manifold below says so.
template <class Chart, class Factor, int kOther>
class FactorCost final : public ceres::SizedCostFunction<Factor::Vector::SizeAtCompileTime,
                                                         Chart::kParameters, kOther> {
 public:
  FactorCost(const Factor& factor, double weight) : factor_(&factor), scale_(std::sqrt(weight)) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    Eigen::Map<typename Factor::Vector> r(residuals);
    if (jacobians == nullptr) {
      r = scale_ * factor_->error(blocks[0], blocks[1]);
      return true;
    }
    typename Factor::ByPose J_pose;
    typename Factor::Matrix J_other;
    r = scale_ * factor_->linearize(blocks[0], blocks[1], J_pose, J_other);
    if (jacobians[0] != nullptr) write<Chart::kParameters>(J_pose, jacobians[0]);
    if (jacobians[1] != nullptr) write<kOther>(J_other, jacobians[1]);
    return true;
  }

 private:
  template <int kParameters, class Jacobian>
  void write(const Jacobian& J, double* jacobian) const {
    constexpr int kSteps = Jacobian::ColsAtCompileTime;
    using Full = Eigen::Matrix<double, Jacobian::RowsAtCompileTime, kParameters, Eigen::RowMajor>;
    Eigen::Map<Full> full(jacobian);
    full.template leftCols<kSteps>() = scale_ * J;
    full.template rightCols<kParameters - kSteps>().setZero();
  }

  const Factor* factor_;
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
      factors_(
          std::make_shared<std::vector<EdgeFactor<Chart>>>(graph.edges.begin(), graph.edges.end())),
      point_factors_(std::make_shared<std::vector<PointFactor<Chart>>>(graph.point_edges.begin(),
                                                                       graph.point_edges.end())) {
  set_placement({graph.poses, graph.points});
}

template <class Chart>
void PoseProblem<Chart>::set_placement(const Placement& placement) {
  parameters_.resize(placement.poses.size() * Chart::kParameters);
  for (size_t node = 0; node < placement.poses.size(); ++node)
    Chart::store(placement.poses[node], parameters_.data() + node * Chart::kParameters);
  point_parameters_.clear();
  for (const Eigen::Vector3d& point : placement.points)
    point_parameters_.insert(point_parameters_.end(), point.data(), point.data() + Chart::kPoint);
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
std::vector<Eigen::Vector3d> PoseProblem<Chart>::points() const {
  std::vector<Eigen::Vector3d> points = graph_->points;
  for (size_t k = 0; k < points.size(); ++k)
    points[k].template head<Chart::kPoint>() =
        Eigen::Map<const typename Chart::PointVector>(point_parameters(static_cast<int>(k)));
  return points;
}

template <class Chart>
std::vector<double> PoseProblem<Chart>::factor_chi2() const {
  std::vector<double> chi2;
  chi2.reserve(factors_->size() + point_factors_->size());
  for (size_t k = 0; k < factors_->size(); ++k)
    chi2.push_back(
        (*factors_)[k].chi2(parameters(graph_->edges[k].from), parameters(graph_->edges[k].to)));
  for (size_t k = 0; k < point_factors_->size(); ++k) {
    const PointEdge& edge = graph_->point_edges[k];
    chi2.push_back((*point_factors_)[k].chi2(parameters(edge.node), point_parameters(edge.point)));
  }
  return chi2;
}

/// The cost functions of one call of the solver; Ceres refers to them.
template <class Chart>
struct PoseProblem<Chart>::Costs {
  explicit Costs(bool robust) {
    if (!robust) return;
    huber = std::make_unique<ceres::HuberLoss>(
        std::sqrt(chi_squared_quantile(Chart::kTangent, kHuberProbability)));
    point_huber = std::make_unique<ceres::HuberLoss>(
        std::sqrt(chi_squared_quantile(Chart::kPoint, kHuberProbability)));
  }

  std::unique_ptr<ceres::HuberLoss> huber;
  std::unique_ptr<ceres::HuberLoss> point_huber;
  std::deque<FactorCost<Chart, EdgeFactor<Chart>, Chart::kParameters>> edges;
  std::deque<FactorCost<Chart, PointFactor<Chart>, Chart::kPoint>> points;
};

template <class Chart>
SolveReport PoseProblem<Chart>::solve(const std::vector<double>& weights, bool huber,
                                      int max_iterations) {
  SpatialManifold manifold;
  Costs costs(huber);
  ceres::Problem problem(problem_options());
  const auto block = [this](int node) {
    return parameters_.data() + static_cast<size_t>(node) * Chart::kParameters;
  };
  for (size_t k = 0; k < factors_->size(); ++k) {
    const PoseGraphEdge& edge = graph_->edges[k];
    const bool both_held =
        held_[static_cast<size_t>(edge.from)] && held_[static_cast<size_t>(edge.to)];
    if (weights[k] <= 0 || both_held) continue;
    costs.edges.emplace_back((*factors_)[k], weights[k]);
    problem.AddResidualBlock(&costs.edges.back(), costs.huber.get(), block(edge.from),
                             block(edge.to));
  }
  for (size_t k = 0; k < point_factors_->size(); ++k) {
    const PointEdge& edge = graph_->point_edges[k];
    const double weight = weights[factors_->size() + k];
    if (weight <= 0) continue;
    costs.points.emplace_back((*point_factors_)[k], weight);
    problem.AddResidualBlock(
        &costs.points.back(), costs.point_huber.get(), block(edge.node),
        point_parameters_.data() + static_cast<size_t>(edge.point) * Chart::kPoint);
  }
  if (problem.NumResidualBlocks() == 0) return {};
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

std::vector<double> factor_chi2(const PoseGraph& graph, const Placement& placement) {
  return with_chart(graph.space, [&](auto chart) {
    PoseProblem<decltype(chart)> problem(graph);
    problem.set_placement(placement);
    return problem.factor_chi2();
  });
}

template class PoseProblem<PlanarChart>;
template class PoseProblem<SpatialChart>;

}  // namespace hmt::graph
