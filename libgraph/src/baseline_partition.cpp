// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/baseline_partition.hpp"

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

void check_groups(int num_nodes, int groups) {
  if (groups < 1 || groups > num_nodes)
    throw InputError("groups is " + std::to_string(groups) + "; " + std::to_string(num_nodes) +
                     " nodes make 1 to " + std::to_string(num_nodes) + " groups");
}

// The rows of METIS: neighbors and whole-numbered weights, which must be above 0.
struct MetisGraph {
  std::vector<idx_t> offsets{0};
  std::vector<idx_t> columns;
  std::vector<idx_t> weights;
};

MetisGraph metis_graph(const WeightedGraph& graph) {
  if (graph.num_arcs() > std::numeric_limits<idx_t>::max() / 2)
    throw InputError("the graph has more arcs than METIS can count");
  double largest = 0;
  for (int i = 0; i < graph.num_nodes(); ++i)
    for (const auto& [node, weight] : graph.neighbors(i)) largest = std::max(largest, weight);
  MetisGraph rows;
  for (int i = 0; i < graph.num_nodes(); ++i) {
    for (const auto& [node, weight] : graph.neighbors(i)) {
      rows.columns.push_back(node);
      rows.weights.push_back(
          std::max<idx_t>(1, static_cast<idx_t>(std::lround(1e6 * weight / largest))));
    }
    rows.offsets.push_back(static_cast<idx_t>(rows.columns.size()));
  }
  return rows;
}

}  // namespace

Labels consecutive_partition(int num_nodes, int groups) {
  check_groups(num_nodes, groups);
  Labels labels;
  for (int64_t i = 0; i < num_nodes; ++i)
    labels.push_back(static_cast<int>(i * groups / num_nodes));
  return labels;
}

Labels metis_partition(const WeightedGraph& graph, int groups) {
  check_groups(graph.num_nodes(), groups);
  // METIS fails on one part, and on a graph without arcs.
  if (groups == 1) return Labels(static_cast<size_t>(graph.num_nodes()), 0);
  if (graph.num_arcs() == 0) return consecutive_partition(graph.num_nodes(), groups);
  MetisGraph rows = metis_graph(graph);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  idx_t nodes = graph.num_nodes();
  idx_t constraints = 1;
  idx_t parts = groups;
  idx_t cut = 0;
  std::vector<idx_t> part(static_cast<size_t>(nodes), 0);
  const int status = METIS_PartGraphKway(&nodes, &constraints, rows.offsets.data(),
                                         rows.columns.data(), nullptr, nullptr, rows.weights.data(),
                                         &parts, nullptr, nullptr, options, &cut, part.data());
  if (status != METIS_OK)
    throw InputError("METIS could not cut the graph into " + std::to_string(groups) + " groups");
  return canonical_labels({part.begin(), part.end()});
}

}  // namespace hmt::graph
