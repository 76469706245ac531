// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "elimination_order.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace hmt::graph {

std::vector<int> elimination_order(int count, const std::vector<std::pair<int, int>>& couplings) {
  std::vector<Eigen::Triplet<double>> pattern;
  pattern.reserve(2 * couplings.size() + static_cast<size_t>(count));
  for (const auto& [a, b] : couplings) {
    if (a < 0 || b < 0) continue;
    pattern.emplace_back(a, b, 1.0);
    pattern.emplace_back(b, a, 1.0);
  }
  for (int i = 0; i < count; ++i) pattern.emplace_back(i, i, 1.0);
  Eigen::SparseMatrix<double> adjacency(count, count);
  adjacency.setFromTriplets(pattern.begin(), pattern.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> old_of_new;
  Eigen::AMDOrdering<int>()(adjacency, old_of_new);
  return {old_of_new.indices().data(), old_of_new.indices().data() + count};
}

std::vector<int> elimination_order(const PoseGraph& graph, const std::vector<bool>& held) {
  std::vector<int> unknown(held.size(), -1);
  int count = 0;
  for (size_t node = 0; node < held.size(); ++node)
    if (!held[node]) unknown[node] = count++;
  std::vector<std::pair<int, int>> couplings;
  couplings.reserve(graph.edges.size());
  for (const PoseGraphEdge& edge : graph.edges)
    couplings.emplace_back(unknown[static_cast<size_t>(edge.from)],
                           unknown[static_cast<size_t>(edge.to)]);
  const std::vector<int> order = elimination_order(count, couplings);
  std::vector<int> position(order.size());
  for (size_t i = 0; i < order.size(); ++i)
    position[static_cast<size_t>(order[i])] = static_cast<int>(i);
  for (int& index : unknown)
    if (index >= 0) index = position[static_cast<size_t>(index)];
  return unknown;
}

}  // namespace hmt::graph
