// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "csr_graph.hpp"

#include <numeric>

namespace hmt::graph {

CsrGraph whole_graph(const WeightedGraph& graph) {
  CsrGraph result;
  const int n = graph.num_nodes();
  result.nodes.resize(static_cast<size_t>(n));
  std::iota(result.nodes.begin(), result.nodes.end(), 0);
  result.offsets.reserve(static_cast<size_t>(n) + 1);
  result.columns.reserve(static_cast<size_t>(graph.num_arcs()) * 2);
  result.weights.reserve(static_cast<size_t>(graph.num_arcs()) * 2);
  for (int i = 0; i < n; ++i) {
    for (const auto& [node, weight] : graph.neighbors(i)) {
      result.columns.push_back(node);
      result.weights.push_back(weight);
    }
    result.offsets.push_back(static_cast<int64_t>(result.columns.size()));
    result.degrees.push_back(graph.degree(i));
  }
  return result;
}

std::vector<CsrGraph> split(const CsrGraph& graph, const std::vector<int>& part, int parts) {
  std::vector<CsrGraph> result(static_cast<size_t>(parts));
  std::vector<int> local(part.size());
  for (size_t i = 0; i < part.size(); ++i) {
    CsrGraph& own = result[static_cast<size_t>(part[i])];
    local[i] = own.size();
    own.nodes.push_back(graph.nodes[i]);
  }
  for (size_t i = 0; i < part.size(); ++i) {
    CsrGraph& own = result[static_cast<size_t>(part[i])];
    double degree = 0;
    for (auto k = static_cast<size_t>(graph.offsets[i]);
         k < static_cast<size_t>(graph.offsets[i + 1]); ++k) {
      const auto j = static_cast<size_t>(graph.columns[k]);
      if (part[j] != part[i]) continue;
      own.columns.push_back(local[j]);
      own.weights.push_back(graph.weights[k]);
      degree += graph.weights[k];
    }
    own.offsets.push_back(static_cast<int64_t>(own.columns.size()));
    own.degrees.push_back(degree);
  }
  return result;
}

std::vector<int> connected_components(const CsrGraph& graph, int* count) {
  std::vector<int> component(graph.nodes.size(), -1);
  std::vector<size_t> stack;
  *count = 0;
  for (size_t seed = 0; seed < component.size(); ++seed) {
    if (component[seed] >= 0) continue;
    component[seed] = *count;
    stack.push_back(seed);
    while (!stack.empty()) {
      const size_t i = stack.back();
      stack.pop_back();
      for (auto k = static_cast<size_t>(graph.offsets[i]);
           k < static_cast<size_t>(graph.offsets[i + 1]); ++k) {
        const auto j = static_cast<size_t>(graph.columns[k]);
        if (component[j] >= 0) continue;
        component[j] = *count;
        stack.push_back(j);
      }
    }
    ++*count;
  }
  return component;
}

Cut measure_cut(const CsrGraph& graph, const Sides& sides) {
  Cut result;
  for (size_t i = 0; i < sides.size(); ++i) {
    (sides[i] == 0 ? result.assoc_a : result.assoc_b) += graph.degrees[i];
    if (sides[i] != 0) continue;
    for (auto k = static_cast<size_t>(graph.offsets[i]);
         k < static_cast<size_t>(graph.offsets[i + 1]); ++k)
      if (sides[static_cast<size_t>(graph.columns[k])] != 0) result.cut += graph.weights[k];
  }
  return result;
}

}  // namespace hmt::graph
