// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// Other ways to cut a graph into a given number of groups, to be compared with min-Ncut. Both
/// return canonical labels and throw InputError where `groups` is not in [1, number of nodes].

/// Runs of consecutive nodes whose lengths differ by one at most: what cutting a log every so many
/// observations gives.
Labels consecutive_partition(int num_nodes, int groups);

/// METIS' k-way partition [Karypis 1998]: least cut between groups of about equal size. Weights are
/// rounded to 10^-6 of the largest. METIS may leave groups empty; then there are fewer.
Labels metis_partition(const WeightedGraph& graph, int groups);

}  // namespace hmt::graph
