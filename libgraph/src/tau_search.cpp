// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/tau_search.hpp"

#include <utility>

namespace hmt::graph {
namespace {

constexpr int kSteps = 100;  // of tau between 0 and 1
constexpr int kLargest = 2 * kSteps - 1;

}  // namespace

std::optional<TauChoice> largest_tau(const WeightedGraph& graph, PartitionOptions options,
                                     const std::function<double(const Labels&)>& loss,
                                     double max_loss, int threads) {
  options.groups.reset();
  std::optional<TauChoice> best;
  // True where the loss at tau = step / 100 is small enough; keeps it then.
  const auto passes = [&](int step) {
    options.tau = static_cast<double>(step) / kSteps;
    TauChoice choice{options.tau, recursive_partition(graph, options, threads), 0};
    choice.loss = loss(choice.partition.labels);
    if (!(choice.loss < max_loss)) return false;
    best = std::move(choice);
    return true;
  };
  if (passes(kLargest)) return best;
  int below = 0;  // the largest step known to pass, 0 for none
  int above = kLargest;
  while (above - below > 1) {
    const int middle = (below + above) / 2;
    (passes(middle) ? below : above) = middle;
  }
  return best;
}

}  // namespace hmt::graph
