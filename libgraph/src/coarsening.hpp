// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "csr_graph.hpp"

namespace hmt::graph {

/// A group with nodes joined to aggregates. The weight inside an aggregate is kept as an arc to
/// itself, so degrees, associations and cuts between aggregates are those of the finer graph.
struct CoarseGraph {
  CsrGraph graph;
  std::vector<int> aggregate;  ///< of every node of the finer graph
};

/// Joins pairs of nodes that are each other's strongest free neighbor, by omega_ij / sqrt(d_i d_j),
/// twice over: about four nodes an aggregate. Independent of the order of the nodes but for equal
/// weights.
CoarseGraph coarsen(const CsrGraph& graph);

}  // namespace hmt::graph
