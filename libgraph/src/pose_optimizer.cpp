// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pose_optimizer.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>

#include "hmt/graph/input_error.hpp"
#include "pose_problem.hpp"
#include "robust_weights.hpp"
#include "start_poses.hpp"

namespace hmt::graph {
namespace {

void check_at_least(const char* name, int value, int least) {
  if (value < least)
    throw InputError(std::string(name) + " is " + std::to_string(value) + "; it must be at least " +
                     std::to_string(least));
}

void check_options(const PoseGraph& graph, const PoseOptimizerOptions& options) {
  check_at_least("max_iterations", options.max_iterations, 1);
  check_at_least("restarts", options.restarts, 0);
  check_at_least("threads", options.threads, 1);
  if (options.initialization == Initialization::random_tree)
    throw InputError("initialization random_tree is for restarts only");
  if (!options.trusted.empty() && options.trusted.size() != graph.edges.size())
    throw InputError("trusted has " + std::to_string(options.trusted.size()) +
                     " flags for a graph of " + std::to_string(graph.edges.size()) +
                     " edges; it needs one an edge");
  if (!options.trusted_points.empty() && options.trusted_points.size() != graph.point_edges.size())
    throw InputError("trusted_points has " + std::to_string(options.trusted_points.size()) +
                     " flags for a graph of " + std::to_string(graph.point_edges.size()) +
                     " point edges; it needs one a point edge");
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Edges between i and i+1, if they join most of the nodes that follow each other: few do by chance
/// where the numbers have no meaning.
std::vector<bool> edges_of_the_sequence(const PoseGraph& graph) {
  std::vector<bool> between(graph.edges.size());
  std::vector<bool> joined(graph.poses.size(), false);
  for (size_t k = 0; k < between.size(); ++k) {
    const PoseGraphEdge& edge = graph.edges[k];
    between[k] = std::abs(edge.to - edge.from) == 1;
    if (between[k]) joined[static_cast<size_t>(std::max(edge.from, edge.to))] = true;
  }
  if (2 * static_cast<size_t>(std::count(joined.begin(), joined.end(), true)) < joined.size())
    between.assign(between.size(), false);
  return between;
}

/// One flag an edge, then one a point edge.
std::vector<bool> trusted_factors(const PoseGraph& graph, const PoseOptimizerOptions& options) {
  std::vector<bool> trusted =
      options.trusted.empty() ? edges_of_the_sequence(graph) : options.trusted;
  trusted.insert(trusted.end(), options.trusted_points.begin(), options.trusted_points.end());
  trusted.resize(graph.edges.size() + graph.point_edges.size(), false);
  return trusted;
}

template <class Chart>
SolveReport solve(const PoseGraph& graph, const PoseOptimizerOptions& options,
                  PoseProblem<Chart>& problem) {
  if (options.robust == RobustMethod::gnc)
    return solve_gnc(graph, trusted_factors(graph, options), options.max_iterations,
                     options.threads, problem);
  const std::vector<double> ones(graph.edges.size() + graph.point_edges.size(), 1.0);
  return problem.solve(ones, options.robust == RobustMethod::huber, options.max_iterations);
}

/// Where one start led.
struct Solution {
  SolveReport solved;
  Placement placement;
  std::vector<double> factor_chi2;
};

template <class Chart>
Solution solve_from(const Start& start, const PoseGraph& graph, const PoseOptimizerOptions& options,
                    PoseProblem<Chart> problem) {
  problem.set_placement({start.poses, start.points});
  Solution solution;
  solution.solved = solve(graph, options, problem);
  solution.placement = problem.placement();
  solution.factor_chi2 = problem.factor_chi2();
  if (solution.solved.inlier.empty())
    solution.solved.inlier.assign(solution.factor_chi2.size(), true);
  return solution;
}

/// The solution of least cost among those that the solver did not give up; the first of equals.
size_t best_of(const std::vector<Solution>& solutions) {
  const auto failed = [](const Solution& s) {
    return s.solved.termination == Termination::failed || !std::isfinite(s.solved.cost);
  };
  size_t best = 0;
  for (size_t k = 1; k < solutions.size(); ++k)
    if (!failed(solutions[k]) &&
        (failed(solutions[best]) || solutions[k].solved.cost < solutions[best].solved.cost))
      best = k;
  return best;
}

/// Measured numbers of the inliers less the free numbers of the poses and of the points seen.
template <class Chart>
double degrees_of_freedom(const PoseGraph& graph, const std::vector<bool>& inlier) {
  const std::vector<bool> held = held_nodes(graph);
  const auto point_edges = inlier.begin() + static_cast<std::ptrdiff_t>(graph.edges.size());
  const auto edges = std::count(inlier.begin(), point_edges, true);
  const auto free_nodes = std::count(held.begin(), held.end(), false);
  std::vector<bool> seen(graph.points.size(), false);
  for (size_t k = 0; k < graph.point_edges.size(); ++k)
    if (point_edges[static_cast<std::ptrdiff_t>(k)])
      seen[static_cast<size_t>(graph.point_edges[k].point)] = true;
  const auto sightings = std::count(point_edges, inlier.end(), true);
  const auto free_points = std::count(seen.begin(), seen.end(), true);
  return static_cast<double>(Chart::kTangent * (edges - free_nodes) +
                             Chart::kPoint * (sightings - free_points));
}

template <class Chart>
PoseOptimizerReport report_of(const PoseGraph& graph, const Solution& solution) {
  PoseOptimizerReport report;
  report.termination = solution.solved.termination;
  report.message = solution.solved.message;
  report.iterations = solution.solved.iterations;
  report.gradient_norm = solution.solved.gradient_norm;
  report.cost = solution.solved.cost;
  report.untrusted_start = solution.solved.untrusted_start;
  const std::vector<double>& chi2 = solution.factor_chi2;
  const std::vector<bool>& inlier = solution.solved.inlier;
  for (size_t k = 0; k < chi2.size(); ++k)
    if (inlier[k]) report.chi2 += chi2[k];
  report.degrees_of_freedom = degrees_of_freedom<Chart>(graph, inlier);
  const auto edges = static_cast<std::ptrdiff_t>(graph.edges.size());
  report.edge_chi2.assign(chi2.begin(), chi2.begin() + edges);
  report.inlier.assign(inlier.begin(), inlier.begin() + edges);
  report.point_chi2.assign(chi2.begin() + edges, chi2.end());
  report.point_inlier.assign(inlier.begin() + edges, inlier.end());
  return report;
}

template <class Chart>
PoseOptimizerResult optimize_in(Chart, const PoseGraph& graph,
                                const PoseOptimizerOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const PoseProblem<Chart> problem(graph);
  PoseProblem<Chart> scratch = problem;
  const std::vector<Start> starts = choose_starts(graph, options.initialization, options.restarts,
                                                  [&](const Placement& placement) {
                                                    scratch.set_placement(placement);
                                                    return sum(scratch.factor_chi2());
                                                  });
  std::vector<Solution> solutions(starts.size());
  tbb::task_arena(options.threads).execute([&] {
    tbb::parallel_for(size_t{0}, starts.size(), [&](size_t k) {
      solutions[k] = solve_from(starts[k], graph, options, problem);
    });
  });
  const size_t best = best_of(solutions);
  PoseOptimizerReport report = report_of<Chart>(graph, solutions[best]);
  report.chi2_initial = sum(problem.factor_chi2());
  report.start = starts[best].kind;
  for (size_t k = 0; k < starts.size(); ++k)
    report.starts.push_back({starts[k].kind, starts[k].chi2, solutions[k].solved.cost,
                             solutions[k].solved.termination});
  report.solve_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  Placement& placement = solutions[best].placement;
  return {std::move(placement.poses), std::move(placement.points), std::move(report)};
}

}  // namespace

PoseOptimizerResult optimize(const PoseGraph& graph, const PoseOptimizerOptions& options) {
  check_options(graph, options);
  check_pose_graph(graph);
  return with_chart(graph.space, [&](auto chart) { return optimize_in(chart, graph, options); });
}

}  // namespace hmt::graph
