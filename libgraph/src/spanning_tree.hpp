// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// Poses chained along a breadth-first tree from the nodes that are `placed`; edges in index order.
/// A component without a placed node grows from the node that its gauge holds.
std::vector<Pose> spanning_tree_poses(const PoseGraph& graph, const std::vector<bool>& placed);

/// The same along a tree that grows by nodes in random order (neither breadth nor depth first), the
/// same one for the same seed; from the held nodes.
std::vector<Pose> random_tree_poses(const PoseGraph& graph, unsigned seed);

}  // namespace hmt::graph
