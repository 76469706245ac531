// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robust_weights.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "consensus_growth.hpp"
#include "hmt/graph/chi_squared.hpp"

namespace hmt::graph {
namespace {

constexpr double kInlierProbability = 0.999;
/// Growth of mu from one surrogate to the next [Yang 2020, Remark 5].
constexpr double kMuFactor = 1.4;
/// The surrogate moves on before its minimum is exact; only the last solve needs that.
constexpr int kIterationsPerSurrogate = 2;
/// Rounds in which edges may still change sides at the end; they settle in one or two.
constexpr int kVerdictRounds = 5;

/// Largest chi2 of a factor that is not trusted, as a multiple of its limit.
double largest_doubted(const std::vector<double>& chi2, const std::vector<bool>& trusted,
                       const std::vector<double>& limits) {
  double largest = 0;
  for (size_t k = 0; k < chi2.size(); ++k)
    if (!trusted[k]) largest = std::max(largest, chi2[k] / limits[k]);
  return largest;
}

bool is_binary(const std::vector<double>& weights) {
  return std::all_of(weights.begin(), weights.end(), [](double w) { return w == 0 || w == 1; });
}

/// Threshold of each factor: of the edges, then of the point edges.
template <class Chart>
std::vector<double> limits_of(const PoseGraph& graph) {
  std::vector<double> limits(graph.edges.size(),
                             chi_squared_quantile(Chart::kTangent, kInlierProbability));
  limits.resize(graph.edges.size() + graph.point_edges.size(),
                chi_squared_quantile(Chart::kPoint, kInlierProbability));
  return limits;
}

std::vector<double> weights_at(const std::vector<double>& chi2, const std::vector<bool>& trusted,
                               const std::vector<double>& limits, double mu) {
  std::vector<double> weights(chi2.size(), 1.0);
  for (size_t k = 0; k < chi2.size(); ++k)
    if (!trusted[k]) weights[k] = truncated_weight(chi2[k], limits[k], mu);
  return weights;
}

/// Solves from surrogate to surrogate until every weight is 0 or 1; returns the iterations.
template <class Chart>
int graduate(PoseProblem<Chart>& problem, const std::vector<bool>& trusted,
             const std::vector<double>& limits, int max_iterations, std::vector<double>& weights) {
  int iterations = problem.solve(weights, false, max_iterations).iterations;
  std::vector<double> chi2 = problem.factor_chi2();
  const double largest = largest_doubted(chi2, trusted, limits);
  if (2 * largest <= 1) return iterations;
  for (double mu = 1 / (2 * largest - 1);; mu *= kMuFactor) {
    weights = weights_at(chi2, trusted, limits, mu);
    if (is_binary(weights)) return iterations;
    iterations += problem.solve(weights, false, kIterationsPerSurrogate).iterations;
    chi2 = problem.factor_chi2();
  }
}

/// Solves over the inliers until no factor changes sides.
template <class Chart>
SolveReport settle(PoseProblem<Chart>& problem, const std::vector<bool>& trusted,
                   const std::vector<double>& limits, int max_iterations,
                   std::vector<double> weights) {
  SolveReport total;
  int iterations = 0;
  for (int round = 0; round < kVerdictRounds; ++round) {
    total = problem.solve(weights, false, max_iterations);
    iterations += total.iterations;
    const std::vector<double> chi2 = problem.factor_chi2();
    total.inlier.assign(chi2.size(), true);
    total.cost = 0;
    bool changed = false;
    for (size_t k = 0; k < chi2.size(); ++k) {
      total.inlier[k] = trusted[k] || chi2[k] <= limits[k];
      total.cost += total.inlier[k] ? chi2[k] : limits[k];
      const double weight = total.inlier[k] ? 1.0 : 0.0;
      changed = changed || weight != weights[k];
      weights[k] = weight;
    }
    if (!changed) break;
  }
  total.iterations = iterations;
  return total;
}

/// Sum of min(chi2, limit), by which verdicts with different limits are compared.
template <class Chart>
double truncated_cost(const PoseProblem<Chart>& problem, const std::vector<bool>& trusted,
                      const std::vector<double>& limits) {
  const std::vector<double> chi2 = problem.factor_chi2();
  double cost = 0;
  for (size_t k = 0; k < chi2.size(); ++k)
    cost += trusted[k] ? chi2[k] : std::min(chi2[k], limits[k]);
  return cost;
}

/// From a set that agrees.
template <class Chart>
SolveReport settle_from(PoseProblem<Chart>& problem, const std::vector<bool>& trusted,
                        const Consensus& consensus, std::vector<double> limits,
                        int max_iterations) {
  for (size_t k = 0; k < limits.size(); ++k)
    if (!consensus.accepted[k]) limits[k] = consensus.limit_of_others;
  return settle(problem, trusted, limits, max_iterations,
                {consensus.accepted.begin(), consensus.accepted.end()});
}

/// By graduated non-convexity from the present placement.
template <class Chart>
SolveReport settle_gradually(PoseProblem<Chart>& problem, const std::vector<bool>& trusted,
                             const std::vector<double>& limits, int max_iterations) {
  std::vector<double> weights(trusted.size(), 1.0);
  const int iterations = graduate(problem, trusted, limits, max_iterations, weights);
  SolveReport report = settle(problem, trusted, limits, max_iterations, weights);
  report.iterations += iterations;
  return report;
}

}  // namespace

double truncated_weight(double chi2, double limit, double mu) {
  if (chi2 <= mu / (mu + 1) * limit) return 1;
  if (chi2 >= (mu + 1) / mu * limit) return 0;
  return std::clamp(std::sqrt(limit / chi2 * mu * (mu + 1)) - mu, 0.0, 1.0);
}

template <class Chart>
SolveReport solve_gnc(const PoseGraph& graph, const std::vector<bool>& trusted, int max_iterations,
                      int threads, PoseProblem<Chart>& problem) {
  const std::vector<double> limits = limits_of<Chart>(graph);
  const double limit = chi_squared_quantile(Chart::kTangent, kInlierProbability);
  PoseProblem<Chart> gradual = problem;
  const auto consensus = grow_consensus(graph, trusted, limit, threads, problem);
  SolveReport report;
  if (consensus) report = settle_from(problem, trusted, *consensus, limits, max_iterations);
  if (consensus && !consensus->guessed) return report;
  SolveReport other = settle_gradually(gradual, trusted, limits, max_iterations);
  if (!consensus ||
      truncated_cost(gradual, trusted, limits) < truncated_cost(problem, trusted, limits)) {
    report = std::move(other);
    problem = std::move(gradual);
  }
  report.untrusted_start = true;
  return report;
}

template SolveReport solve_gnc(const PoseGraph&, const std::vector<bool>&, int, int,
                               PoseProblem<PlanarChart>&);
template SolveReport solve_gnc(const PoseGraph&, const std::vector<bool>&, int, int,
                               PoseProblem<SpatialChart>&);

}  // namespace hmt::graph
