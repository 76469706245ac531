// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "elimination_order.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace hmt::graph {

std::vector<int> elimination_order(const PoseGraph& graph, const std::vector<bool>& held) {
  std::vector<int> free_index(held.size(), -1);
  int count = 0;
  for (size_t node = 0; node < held.size(); ++node)
    if (!held[node]) free_index[node] = count++;
  std::vector<Eigen::Triplet<double>> pattern;
  pattern.reserve(2 * graph.edges.size() + held.size());
  for (const PoseGraphEdge& edge : graph.edges) {
    const int a = free_index[static_cast<size_t>(edge.from)];
    const int b = free_index[static_cast<size_t>(edge.to)];
    if (a < 0 || b < 0) continue;
    pattern.emplace_back(a, b, 1.0);
    pattern.emplace_back(b, a, 1.0);
  }
  for (int i = 0; i < count; ++i) pattern.emplace_back(i, i, 1.0);
  Eigen::SparseMatrix<double> adjacency(count, count);
  adjacency.setFromTriplets(pattern.begin(), pattern.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> old_of_new;
  Eigen::AMDOrdering<int>()(adjacency, old_of_new);
  std::vector<int> new_of_old(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) new_of_old[static_cast<size_t>(old_of_new.indices()(i))] = i;
  for (int& index : free_index)
    if (index >= 0) index = new_of_old[static_cast<size_t>(index)];
  return free_index;
}

}  // namespace hmt::graph
