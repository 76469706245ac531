// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/normalized_cut.hpp"

#include <algorithm>
#include <string>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

void check_labels(const WeightedGraph& graph, const Labels& labels) {
  if (labels.size() != static_cast<size_t>(graph.num_nodes()))
    throw InputError("a graph of " + std::to_string(graph.num_nodes()) + " nodes got " +
                     std::to_string(labels.size()) + " labels; it needs one label a node");
  for (size_t i = 0; i < labels.size(); ++i)
    if (labels[i] < 0)
      throw InputError("the label of node " + std::to_string(i) + " is " +
                       std::to_string(labels[i]) + "; labels must be >= 0");
}

}  // namespace

double Cut::ncut() const {
  if (cut == 0) return 0;
  return cut / assoc_a + cut / assoc_b;
}

Cut cut_between(const WeightedGraph& graph, const Labels& labels, int a, int b) {
  check_labels(graph, labels);
  Cut result;
  for (int i = 0; i < graph.num_nodes(); ++i) {
    const int own = labels[static_cast<size_t>(i)];
    if (own != a && own != b) continue;
    for (const auto& [j, weight] : graph.neighbors(i)) {
      const int other = labels[static_cast<size_t>(j)];
      if (other != a && other != b) continue;
      (own == a ? result.assoc_a : result.assoc_b) += weight;
      if (own == a && other == b) result.cut += weight;
    }
  }
  return result;
}

double kway_ncut(const WeightedGraph& graph, const Labels& labels) {
  check_labels(graph, labels);
  const int groups = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
  std::vector<double> cut(static_cast<size_t>(groups), 0);
  std::vector<double> assoc(static_cast<size_t>(groups), 0);
  for (int i = 0; i < graph.num_nodes(); ++i) {
    const auto own = static_cast<size_t>(labels[static_cast<size_t>(i)]);
    for (const auto& [j, weight] : graph.neighbors(i)) {
      assoc[own] += weight;
      if (static_cast<size_t>(labels[static_cast<size_t>(j)]) != own) cut[own] += weight;
    }
  }
  double sum = 0;
  for (size_t k = 0; k < cut.size(); ++k)
    if (cut[k] > 0) sum += cut[k] / assoc[k];
  return sum;
}

}  // namespace hmt::graph
