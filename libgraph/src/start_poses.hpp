// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "hmt/graph/pose_initialization.hpp"
#include "pose_problem.hpp"

namespace hmt::graph {

/// Sum of r^T Omega r over all factors of a graph at a placement.
using Chi2OfPlacement = std::function<double(const Placement&)>;

/// The start that is asked for (`best`: the one of least chi2), then `restarts` further ones. A
/// chordal relaxation that does not exist gives way to the poses of the graph.
std::vector<Start> choose_starts(const PoseGraph& graph, Initialization wanted, int restarts,
                                 const Chi2OfPlacement& chi2_of);

}  // namespace hmt::graph
