// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bisection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "cut_refinement.hpp"
#include "fiedler.hpp"

namespace hmt::graph {
namespace {

// Eigenvectors that are tried before a group is declared whole.
constexpr int kVectors = 3;

std::vector<int> sorted_by(const std::vector<double>& y) {
  std::vector<int> order(y.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&y](int a, int b) {
    const double ya = y[static_cast<size_t>(a)];
    const double yb = y[static_cast<size_t>(b)];
    return ya != yb ? ya < yb : a < b;
  });
  return order;
}

// Nodes before the best place to cut `order` [Shi 2000]: one walk updates the cut arc by arc.
size_t best_prefix(const CsrGraph& graph, const std::vector<int>& order) {
  const double total = std::accumulate(graph.degrees.begin(), graph.degrees.end(), 0.0);
  std::vector<uint8_t> moved(order.size(), 0);
  double cut = 0;
  double assoc = 0;
  double best = std::numeric_limits<double>::infinity();
  size_t best_size = 1;
  for (size_t position = 0; position + 1 < order.size(); ++position) {
    const auto i = static_cast<size_t>(order[position]);
    double to_moved = 0;
    for (auto k = static_cast<size_t>(graph.offsets[i]);
         k < static_cast<size_t>(graph.offsets[i + 1]); ++k)
      if (moved[static_cast<size_t>(graph.columns[k])] != 0) to_moved += graph.weights[k];
    moved[i] = 1;
    cut += graph.degrees[i] - 2 * to_moved;
    assoc += graph.degrees[i];
    const double ncut = cut / assoc + cut / (total - assoc);
    if (ncut < best) {
      best = ncut;
      best_size = position + 1;
    }
  }
  return best_size;
}

Sides above(const std::vector<double>& y, double limit) {
  Sides sides(y.size());
  for (size_t i = 0; i < y.size(); ++i) sides[i] = y[i] > limit ? 1 : 0;
  return sides;
}

bool one_sided(const Sides& sides) {
  return std::all_of(sides.begin(), sides.end(), [&](uint8_t s) { return s == sides.front(); });
}

// y = D^{-1/2} z, Eq. 10 and 11.
std::vector<double> cut_vector(const CsrGraph& graph, const FiedlerPairs& pairs, int k) {
  std::vector<double> y(graph.degrees.size());
  for (size_t i = 0; i < y.size(); ++i)
    y[i] = pairs.z(static_cast<Eigen::Index>(i), k) / std::sqrt(graph.degrees[i]);
  return y;
}

std::vector<Threshold> thresholds_from(Threshold first) {
  std::vector<Threshold> all = {first};
  for (const Threshold t : {Threshold::sweep, Threshold::mean, Threshold::sign})
    if (t != first) all.push_back(t);
  return all;
}

}  // namespace

Bisection report(const SpectralCut& cut) {
  const auto above = static_cast<int>(std::count(cut.sides.begin(), cut.sides.end(), 1));
  return {static_cast<int>(cut.sides.size()) - above, above, cut.ncut, cut.lambda_2, cut.residual};
}

std::optional<Sides> threshold_cut(const CsrGraph& graph, const std::vector<double>& y,
                                   Threshold threshold) {
  if (y.size() < 2) return std::nullopt;
  if (threshold == Threshold::sweep) {
    const std::vector<int> order = sorted_by(y);
    Sides sides(y.size(), 1);
    const size_t size = best_prefix(graph, order);
    for (size_t k = 0; k < size; ++k) sides[static_cast<size_t>(order[k])] = 0;
    return sides;
  }
  const double mean = std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
  Sides sides = above(y, threshold == Threshold::mean ? mean : 0.0);
  if (one_sided(sides)) return std::nullopt;
  return sides;
}

std::optional<SpectralCut> spectral_cut(const CsrGraph& graph, const PartitionOptions& options,
                                        std::optional<double> tau) {
  if (graph.size() < 2) return std::nullopt;
  FiedlerSolver solver(graph);
  FiedlerPairs pairs = solver.pairs(1);
  // No cut is below lambda_2 [Shi 2000]; the margin covers the accuracy of the eigenvalue.
  if (tau && pairs.lambda[0] - pairs.residual >= *tau) return std::nullopt;
  SpectralCut best{{}, std::numeric_limits<double>::infinity(), pairs.lambda[0], pairs.residual};
  for (int k = 0; k < pairs.lambda.size(); ++k) {
    const std::vector<double> y = cut_vector(graph, pairs, k);
    for (const Threshold threshold : thresholds_from(options.threshold)) {
      std::optional<Sides> sides = threshold_cut(graph, y, threshold);
      if (!sides) continue;
      if (options.refine) refine_cut(graph, *sides);
      const double ncut = measure_cut(graph, *sides).ncut();
      if (ncut < best.ncut) {
        best.ncut = ncut;
        best.sides = std::move(*sides);
      }
      if (tau && best.ncut < *tau) return best;
      if (!options.refine) break;
    }
    if (!options.refine) break;
    if (k == 0) pairs = solver.pairs(kVectors);  // most groups need no more than the first
  }
  if (tau || best.sides.empty()) return std::nullopt;
  return best;
}

}  // namespace hmt::graph
