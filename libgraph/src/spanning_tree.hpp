// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// Poses chained along a breadth-first tree over the edges `use` (empty: every edge), from all held
/// nodes at once; edges in index order. Nodes that the tree does not reach keep their pose.
std::vector<Pose> spanning_tree_poses(const PoseGraph& graph, const std::vector<bool>& use = {});

}  // namespace hmt::graph
