// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "command.hpp"
#include "hmt/graph/partition.hpp"
#include "partition_input.hpp"

namespace hmt::apps {

/// How a graph is cut into groups: min-Ncut; every so many keyframes, metres or seconds; METIS.
enum class PartitionMethod { ncut, fixed, distance, time, metis };

struct MethodChoice {
  PartitionMethod method = PartitionMethod::ncut;
  /// Keyframes, metres or seconds of a group, for `fixed`, `distance` and `time`.
  std::optional<double> every;
};

/// Labels by the method. Others than min-Ncut need options.groups; `fixed`, `distance` and `time`
/// may have `every` instead.
graph::PartitionResult partition_by(const MethodChoice& choice, const PartitionInput& input,
                                    const graph::PartitionOptions& options, int threads);

/// Nodes of every group.
std::vector<int> group_sizes(const graph::Labels& labels);

/// Prints groups, sizes, k-way Ncut and information loss over tau; with `csv_file` the same as CSV,
/// too. A matrix has no information loss.
int print_tau_sweep(const PartitionInput& input, graph::PartitionOptions options,
                    const std::string& csv_file, const Globals& globals);

/// Prints all methods that the input allows side by side, at the number of groups that min-Ncut
/// makes with `options`.
int print_method_comparison(const PartitionInput& input, graph::PartitionOptions options,
                            const Globals& globals);

}  // namespace hmt::apps
