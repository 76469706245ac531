// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// Position of every free node in a fill-reducing elimination order; -1 for a held node.
std::vector<int> elimination_order(const PoseGraph& graph, const std::vector<bool>& held);

}  // namespace hmt::graph
