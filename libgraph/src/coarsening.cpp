// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "coarsening.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace hmt::graph {
namespace {

// Most nodes have found a partner by then; the others stay alone.
constexpr int kMatchingRounds = 6;

// Partner of every node, itself where it has none.
std::vector<int> match(const CsrGraph& graph) {
  const auto n = static_cast<size_t>(graph.size());
  std::vector<int> partner(n);
  std::iota(partner.begin(), partner.end(), 0);
  std::vector<int> choice(n, -1);
  for (int round = 0; round < kMatchingRounds; ++round) {
    for (size_t i = 0; i < n; ++i) {
      choice[i] = -1;
      if (partner[i] != static_cast<int>(i)) continue;
      double strongest = 0;
      for (auto k = static_cast<size_t>(graph.offsets[i]);
           k < static_cast<size_t>(graph.offsets[i + 1]); ++k) {
        const int j = graph.columns[k];
        if (j == static_cast<int>(i) || partner[static_cast<size_t>(j)] != j) continue;
        // omega_ij / sqrt(d_i d_j) up to the factor that is the same for the whole row.
        const double strength = graph.weights[k] / std::sqrt(graph.degrees[static_cast<size_t>(j)]);
        if (strength > strongest) {
          strongest = strength;
          choice[i] = j;
        }
      }
    }
    for (size_t i = 0; i < n; ++i)
      if (choice[i] >= 0 && choice[static_cast<size_t>(choice[i])] == static_cast<int>(i))
        partner[i] = choice[i];
  }
  return partner;
}

CoarseGraph join_pairs(const CsrGraph& graph) {
  const std::vector<int> partner = match(graph);
  CoarseGraph result;
  CsrGraph& coarse = result.graph;
  result.aggregate.assign(partner.size(), 0);
  for (size_t i = 0; i < partner.size(); ++i) {
    const auto other = static_cast<size_t>(partner[i]);
    if (other < i) {
      result.aggregate[i] = result.aggregate[other];
      continue;
    }
    result.aggregate[i] = coarse.size();
    coarse.nodes.push_back(static_cast<int>(i));
  }
  std::vector<double> sum(coarse.nodes.size(), 0);
  std::vector<int> row;
  for (const int first : coarse.nodes) {
    row.clear();
    double degree = 0;
    const auto add = [&](size_t i) {
      degree += graph.degrees[i];
      for (auto k = static_cast<size_t>(graph.offsets[i]);
           k < static_cast<size_t>(graph.offsets[i + 1]); ++k) {
        const int column = result.aggregate[static_cast<size_t>(graph.columns[k])];
        double& entry = sum[static_cast<size_t>(column)];
        if (entry == 0) row.push_back(column);
        entry += graph.weights[k];
      }
    };
    add(static_cast<size_t>(first));
    if (const int other = partner[static_cast<size_t>(first)]; other != first)
      add(static_cast<size_t>(other));
    std::sort(row.begin(), row.end());
    for (const int column : row) {
      coarse.columns.push_back(column);
      coarse.weights.push_back(std::exchange(sum[static_cast<size_t>(column)], 0));
    }
    coarse.offsets.push_back(static_cast<int64_t>(coarse.columns.size()));
    coarse.degrees.push_back(degree);
  }
  return result;
}

}  // namespace

CoarseGraph coarsen(const CsrGraph& graph) {
  CoarseGraph pairs = join_pairs(graph);
  CoarseGraph fours = join_pairs(pairs.graph);
  for (int& aggregate : pairs.aggregate)
    aggregate = fours.aggregate[static_cast<size_t>(aggregate)];
  return {std::move(fours.graph), std::move(pairs.aggregate)};
}

}  // namespace hmt::graph
