// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// Exactly `*options.groups` groups of a graph with at least one node: the group whose cut has the
/// least Ncut is cut next; disconnected groups come first, at Ncut 0. Throws InputError where
/// min_size does not allow the number.
PartitionResult best_first_partition(const WeightedGraph& graph, const PartitionOptions& options,
                                     int threads);

/// The same where the last bit of Ncut does not matter, faster on large graphs: nodes are joined to
/// aggregates, at least sixteen a group on average, and these are cut. No refinement across groups.
Labels coarse_best_first_labels(const WeightedGraph& graph, int groups, int threads);

}  // namespace hmt::graph
