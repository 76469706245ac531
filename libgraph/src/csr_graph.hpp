// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "hmt/graph/normalized_cut.hpp"
#include "hmt/graph/weighted_graph.hpp"

namespace hmt::graph {

/// Group of nodes with the arcs among them, in compressed rows: what the recursion hands down.
/// Local node i is node `nodes[i]` of the whole graph; `nodes` ascends.
struct CsrGraph {
  std::vector<int> nodes;
  std::vector<int64_t> offsets{0};
  std::vector<int> columns;
  std::vector<double> weights;
  std::vector<double> degrees;  ///< row sums: the degrees within the group

  int size() const { return static_cast<int>(nodes.size()); }
};

/// Side (0 or 1) of every local node.
using Sides = std::vector<uint8_t>;

/// The whole graph as one group.
CsrGraph whole_graph(const WeightedGraph& graph);

/// The `parts` groups that `part` (0..parts-1, one value a local node) cuts out of `graph`; arcs
/// between different parts are dropped.
std::vector<CsrGraph> split(const CsrGraph& graph, const std::vector<int>& part, int parts);

/// Connected component of every local node, numbered in the order of their smallest node, and how
/// many there are.
std::vector<int> connected_components(const CsrGraph& graph, int* count);

/// Eq. 2 and 3 for the two sides.
Cut measure_cut(const CsrGraph& graph, const Sides& sides);

}  // namespace hmt::graph
