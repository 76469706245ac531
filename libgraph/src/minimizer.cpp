// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "minimizer.hpp"

#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "openmp_guard.hpp"

namespace hmt::graph {
namespace {

/// Damping is the diagonal of the normal equations by the radius of the trust region. The condition
/// of a pose graph grows with the length of its loops, up to some 1e12 for a million poses; any
/// damping that is seen beside its smallest eigenvalues costs iterations. This one is rounding.
constexpr double kGaussNewtonRadius = 1e16;
/// Where a full step was too long: of 1e4 to 1e12, this took the fewest iterations from there.
constexpr double kDampedRadius = 1e10;
/// Decrease still to come, as a share of the cost, that is not worth a step. The extrapolation is
/// linear and the convergence faster, so what is really left is less.
constexpr double kWorthlessDecrease = 1e-9;

/// Watches the steps, and stops where nothing is left to gain or, `until_refusal`, where a step did
/// not lower the cost.
class StepWatcher final : public ceres::IterationCallback {
 public:
  explicit StepWatcher(bool until_refusal) : until_refusal_(until_refusal) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& step) override {
    if (step.iteration == 0) return ceres::SOLVER_CONTINUE;
    if (!step.step_is_successful) {
      refused_ = true;
      last_decrease_ = 0;
      return until_refusal_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
    }
    converged_ = is_last(step);
    last_decrease_ = step.cost_change;
    return converged_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  bool refused() const { return refused_; }
  bool converged() const { return converged_; }

 private:
  bool is_last(const ceres::IterationSummary& step) const {
    if (last_decrease_ <= 0 || step.cost_change >= last_decrease_) return false;
    const double ratio = step.cost_change / last_decrease_;
    return step.cost_change * ratio / (1 - ratio) <= kWorthlessDecrease * step.cost;
  }

  bool until_refusal_;
  bool refused_ = false;
  bool converged_ = false;
  double last_decrease_ = 0;
};

ceres::Solver::Options solver_options(double radius, int max_iterations, StepWatcher& watcher) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.initial_trust_region_radius = radius;
  options.max_trust_region_radius = kGaussNewtonRadius;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-9;
  options.gradient_tolerance = 1e-10;
  options.parameter_tolerance = 1e-10;
  options.num_threads = 1;
  // The factor does not depend on the scale of the columns, nor does the damping.
  options.jacobi_scaling = false;
  options.logging_type = ceres::SILENT;
  options.callbacks = {&watcher};
  return options;
}

Termination termination_of(const ceres::Solver::Summary& summary) {
  if (summary.termination_type == ceres::CONVERGENCE ||
      summary.termination_type == ceres::USER_SUCCESS)
    return Termination::converged;
  return summary.termination_type == ceres::NO_CONVERGENCE ? Termination::iteration_limit
                                                           : Termination::failed;
}

void run(ceres::Problem& problem, double radius, int max_iterations, StepWatcher& watcher,
         MinimizerReport& report) {
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(radius, max_iterations, watcher), &problem, &summary);
  report.termination = termination_of(summary);
  report.message = watcher.converged() ? "the next step would gain nothing" : summary.message;
  if (summary.iterations.empty()) return;
  report.iterations += static_cast<int>(summary.iterations.size()) - 1;
  report.gradient_norm = summary.iterations.back().gradient_max_norm;
  report.cost = 2 * summary.final_cost;
}

}  // namespace

MinimizerReport minimize(ceres::Problem& problem, int max_iterations) {
  const OpenMpGuard guard;
  MinimizerReport report;
  StepWatcher full_steps(true);
  run(problem, kGaussNewtonRadius, max_iterations, full_steps, report);
  if (!full_steps.refused()) return report;
  if (report.iterations >= max_iterations) {
    report.termination = Termination::iteration_limit;
    return report;
  }
  StepWatcher damped_steps(false);
  run(problem, kDampedRadius, max_iterations - report.iterations, damped_steps, report);
  return report;
}

}  // namespace hmt::graph
