// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// A threshold with the partition that it makes and what that costs.
struct TauChoice {
  double tau = 0;
  PartitionResult partition;
  double loss = 0;
};

/// The largest tau whose partition loses less than `max_loss`, to the hundredth: at the next
/// hundredth of tau, up to 1.99, the loss is not below it. Found by bisection (some eight
/// partitions), because a larger tau cuts the groups of a smaller one further, so the loss grows
/// with tau. Nothing where even tau = 0.01 loses that much. Of `options` all but tau and groups
/// count. Throws InputError as recursive_partition does.
std::optional<TauChoice> largest_tau(const WeightedGraph& graph, PartitionOptions options,
                                     const std::function<double(const Labels&)>& loss,
                                     double max_loss, int threads = 1);

}  // namespace hmt::graph
