// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// Other ways to cut a sequence of nodes or a graph into groups, to be compared with min-Ncut. All
/// return canonical labels; those with `groups` throw InputError where it is not in [1, number of
/// nodes].

/// Runs of consecutive nodes whose lengths differ by one at most: what cutting a log every so many
/// observations gives.
Labels consecutive_partition(int num_nodes, int groups);

/// Runs of consecutive nodes that end every `length` of what grows along the sequence, such as the
/// metres travelled or the seconds passed: node i is in run floor((along[i] - along[0]) / length),
/// runs without a node not counted. Throws InputError where `length` is not above 0, or `along`
/// falls or is not finite, naming the node.
Labels runs_of_length(std::span<const double> along, double length);

/// The same with the length that makes that many runs from the first node to the last. Fewer where
/// a run has no node.
Labels runs_of_equal_length(std::span<const double> along, int groups);

/// METIS' k-way partition [Karypis 1998]: least cut between groups of about equal size. Weights are
/// rounded to 10^-6 of the largest. METIS may leave groups empty; then there are fewer.
Labels metis_partition(const WeightedGraph& graph, int groups);

}  // namespace hmt::graph
