// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// Where the unknowns of a pose graph stand in its information matrix.
struct EliminationLayout {
  std::vector<int> node;   ///< first row of each node; -1 for a held one
  std::vector<int> point;  ///< first row of each point; -1 for one that no edge measures
  int size = 0;            ///< rows of the matrix
};

/// A fill-reducing order (approximate minimum degree) of the nodes that are not held and the
/// points.
EliminationLayout elimination_layout(const PoseGraph& graph, const std::vector<bool>& held);

}  // namespace hmt::graph
