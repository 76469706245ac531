// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace hmt::graph {

/// Nodes of a largest set that are pairwise adjacent, ascending; among several of that size the
/// first in lexicographic order. `adjacent` is symmetric; its diagonal is not read. Exact branch
/// and bound with a coloring bound [Tomita 2003] as long as it needs no more than `max_branches`
/// branches, then the largest set found so far.
std::vector<int> maximum_clique(const std::vector<std::vector<bool>>& adjacent,
                                long max_branches = 2'000'000);

}  // namespace hmt::graph
