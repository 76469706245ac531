// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pose_optimizer.hpp"

#include <chrono>
#include <numeric>
#include <string>

#include "hmt/graph/chi_squared.hpp"
#include "hmt/graph/input_error.hpp"
#include "pose_problem.hpp"
#include "robust_weights.hpp"
#include "spanning_tree.hpp"

namespace hmt::graph {
namespace {

void check_options(const PoseGraph& graph, const PoseOptimizerOptions& options) {
  if (options.max_iterations < 1)
    throw InputError("max_iterations is " + std::to_string(options.max_iterations) +
                     "; it must be at least 1");
  if (options.threads < 1)
    throw InputError("threads is " + std::to_string(options.threads) + "; it must be at least 1");
  if (!options.trusted.empty() && options.trusted.size() != graph.edges.size())
    throw InputError("trusted has " + std::to_string(options.trusted.size()) +
                     " flags for a graph of " + std::to_string(graph.edges.size()) +
                     " edges; it needs one an edge");
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

std::vector<bool> trusted_edges(const PoseGraph& graph, const PoseOptimizerOptions& options) {
  if (!options.trusted.empty()) return options.trusted;
  std::vector<bool> trusted(graph.edges.size());
  for (size_t k = 0; k < trusted.size(); ++k)
    trusted[k] = std::abs(graph.edges[k].to - graph.edges[k].from) == 1;
  return trusted;
}

/// Moves the problem to the start of least chi2.
template <class Chart>
Initialization take_best_start(const PoseGraph& graph, PoseProblem<Chart>& problem) {
  const double chi2_given = sum(problem.edge_chi2());
  problem.set_poses(spanning_tree_poses(graph));
  if (sum(problem.edge_chi2()) < chi2_given) return Initialization::best;
  problem.set_poses(graph.poses);
  return Initialization::given;
}

template <class Chart>
SolveReport solve(const PoseGraph& graph, const PoseOptimizerOptions& options,
                  PoseProblem<Chart>& problem, std::vector<bool>& inlier) {
  const std::vector<double> ones(graph.edges.size(), 1.0);
  inlier.assign(graph.edges.size(), true);
  if (options.robust == RobustMethod::gnc)
    return solve_gnc(problem, trusted_edges(graph, options), options.max_iterations, inlier);
  const double huber_chi2 =
      options.robust == RobustMethod::huber ? chi_squared_quantile(Chart::kTangent, 0.95) : 0.0;
  return problem.solve(ones, huber_chi2, options.max_iterations);
}

template <class Chart>
PoseOptimizerResult optimize_in(Chart, const PoseGraph& graph,
                                const PoseOptimizerOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  PoseProblem<Chart> problem(graph);
  PoseOptimizerReport report;
  report.chi2_initial = sum(problem.edge_chi2());
  if (options.initialization == Initialization::best)
    report.start = take_best_start(graph, problem);
  const SolveReport solved = solve(graph, options, problem, report.inlier);
  report.termination = solved.termination;
  report.message = solved.message;
  report.iterations = solved.iterations;
  report.edge_chi2 = problem.edge_chi2();
  for (size_t k = 0; k < report.edge_chi2.size(); ++k)
    if (report.inlier[k]) report.chi2 += report.edge_chi2[k];
  report.solve_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return {problem.poses(), report};
}

}  // namespace

PoseOptimizerResult optimize(const PoseGraph& graph, const PoseOptimizerOptions& options) {
  check_options(graph, options);
  check_pose_graph(graph);
  return with_chart(graph.space, [&](auto chart) { return optimize_in(chart, graph, options); });
}

}  // namespace hmt::graph
