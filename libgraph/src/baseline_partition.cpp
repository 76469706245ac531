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

void check_growing(std::span<const double> along) {
  for (size_t i = 0; i < along.size(); ++i)
    if (!std::isfinite(along[i]) || (i > 0 && along[i] < along[i - 1]))
      throw InputError("node " + std::to_string(i) + " lies at " + std::to_string(along[i]) +
                       " along the sequence; it must be finite and not before the last one");
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

Labels runs_of_length(std::span<const double> along, double length) {
  if (!(length > 0))
    throw InputError("the length of a run is " + std::to_string(length) + "; it must be above 0");
  check_growing(along);
  // Only whether two neighbors are in the same run matters; the number of a run may be huge.
  Labels labels(along.size(), 0);
  const auto run = [&](size_t i) { return std::floor((along[i] - along[0]) / length); };
  for (size_t i = 1; i < along.size(); ++i)
    labels[i] = labels[i - 1] + (run(i) > run(i - 1) ? 1 : 0);
  return labels;
}

Labels runs_of_equal_length(std::span<const double> along, int groups) {
  check_groups(static_cast<int>(along.size()), groups);
  check_growing(along);
  const double whole = along.back() - along.front();
  Labels labels;
  for (const double at : along) {
    const double share = whole > 0 ? (at - along.front()) / whole : 0;
    labels.push_back(std::min(groups - 1, static_cast<int>(share * groups)));
  }
  return canonical_labels(labels);
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
