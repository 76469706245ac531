// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <vector>

#include "hmt/graph/pose_initialization.hpp"

namespace hmt::graph {

/// Sum of r^T Omega r over all edges of a graph at the given poses.
using Chi2OfPoses = std::function<double(const std::vector<Pose>&)>;

/// The start that is asked for (`best`: the one of least chi2), then `restarts` further ones. A
/// chordal relaxation that does not exist gives way to the poses of the graph.
std::vector<Start> choose_starts(const PoseGraph& graph, Initialization wanted, int restarts,
                                 const Chi2OfPoses& chi2_of);

}  // namespace hmt::graph
