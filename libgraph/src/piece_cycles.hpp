// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "hmt/graph/pose_covariance.hpp"
#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// What the search for cycles may believe.
struct CycleGate {
  double limit = 0;       ///< of r^T S^-1 r of a closed cycle
  double log_volume = 0;  ///< of all relative poses within the map
};

/// Edges of cycles over pieces that close: from piece to piece by edges, within a piece by the
/// present solution with its covariance. Only cycles of the least number of pieces, from two up, at
/// which any are found. A cycle counts where fewer than one in a hundred such sets of cycles would
/// hold one that closes by chance, and where no two of its edges run beside each other. Cycles are
/// taken in the order of how little would close by chance; none joins two pieces that those before
/// it have joined.
template <class Chart>
std::vector<size_t> closing_edges(const PoseGraph& graph, const std::vector<Pose>& poses,
                                  const PoseCovariance& covariance, const std::vector<int>& piece,
                                  const std::function<bool(size_t, size_t)>& beside,
                                  const CycleGate& gate);

}  // namespace hmt::graph
