// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// Lowers the k-way Ncut of a partition, sum over groups of cut(A)/assoc(A), at the same number of
/// groups: nodes move between neighboring groups, two groups are merged while a third is cut where
/// that pays, and two neighbors are cut anew; the last two up to 500 groups. Never worse than what
/// is given, and the given labels (canonical) where nothing lowers it. Disconnected groups and
/// groups below `min_size` nodes are not cut. Throws InputError where the labels do not fit the
/// graph.
Labels refine_groups(const WeightedGraph& graph, const Labels& labels, int min_size = 1);

}  // namespace hmt::graph
