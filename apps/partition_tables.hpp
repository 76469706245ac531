// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "command.hpp"
#include "hmt/graph/partition.hpp"

namespace hmt::apps {

/// How a graph is cut into groups.
enum class PartitionMethod { ncut, fixed, metis };

/// Labels by the method; `fixed` and `metis` need options.groups.
graph::PartitionResult partition_by(PartitionMethod method, const graph::WeightedGraph& overlap,
                                    const graph::PartitionOptions& options, int threads);

/// Nodes of every group.
std::vector<int> group_sizes(const graph::Labels& labels);

/// Prints groups, sizes and k-way Ncut over tau; with `csv_file` the same as CSV, too.
int print_tau_sweep(const graph::WeightedGraph& overlap, graph::PartitionOptions options,
                    const std::string& csv_file, const Globals& globals);

/// Prints all methods side by side, at the number of groups that min-Ncut makes with `options`.
int print_method_comparison(const graph::WeightedGraph& overlap, graph::PartitionOptions options,
                            const Globals& globals);

}  // namespace hmt::apps
