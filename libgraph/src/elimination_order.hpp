// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// Unknowns 0..count-1 in a fill-reducing order of elimination (approximate minimum degree); two of
/// them are coupled where the matrix has an entry. A coupling with a negative number is none.
std::vector<int> elimination_order(int count, const std::vector<std::pair<int, int>>& couplings);

/// Position of every free node in a fill-reducing elimination order; -1 for a held node.
std::vector<int> elimination_order(const PoseGraph& graph, const std::vector<bool>& held);

}  // namespace hmt::graph
