// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::benchmarks {

/// A pose graph of which some loops are false, and which.
struct CorruptedGraph {
  graph::PoseGraph graph;
  std::vector<bool> is_loop;   ///< one flag an edge: not between i and i+1
  std::vector<bool> is_false;  ///< one flag an edge
  std::vector<int> place;      ///< node of `graph` that a node of the clean graph has become
};

/// What the false loops look like.
enum class FalsePose {
  anywhere,   ///< a random relative pose within the extent of the map
  same_place  ///< two random nodes taken for the same place: next to no offset
};

/// Replaces `share` of the loops of `clean` by false ones with the information of the edge that
/// each of them replaces: each between two random nodes, or `group_size` > 1 in groups that agree
/// with each other (the same wrong offset between two stretches of the trajectory). The poses of
/// `clean` are taken for the truth within a group.
CorruptedGraph add_false_loops(const graph::PoseGraph& clean, double share, int group_size,
                               FalsePose kind, unsigned seed);

/// The same graph without the edge between i and i+1 at `sessions` - 1 evenly spaced places: drives
/// that only their loops join.
CorruptedGraph cut_into_sessions(CorruptedGraph corrupted, int sessions);

/// The same graph with its nodes in random order, so that their numbers say nothing about which
/// edges are odometry.
CorruptedGraph shuffle_nodes(CorruptedGraph corrupted, unsigned seed);

}  // namespace hmt::benchmarks
