// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// Lowers the k-way Ncut by short chains of moves that start at one node and go on among its
/// neighbors, through worse states to better ones; so a surplus travels over several groups to
/// where it is wanted, which no exchange between two groups can do. Every group keeps a node. True
/// where `labels` changed; never worse but for rounding.
bool refine_by_chains(const WeightedGraph& graph, Labels& labels);

}  // namespace hmt::graph
