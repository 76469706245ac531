// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "pose_problem.hpp"

namespace hmt::graph {

/// A set of edges that agree, grown from the trusted ones: each round predicts the error of every
/// other edge with the covariance of the present solution, S = cov(T_from_to) + information^-1, and
/// accepts those with r^T S^-1 r <= `limit`, beginning with the edges whose acceptance says most:
/// where a false edge, placed anywhere in the map, would pass with the least probability. Then the
/// graph is solved again, which sharpens the predictions, and accepted edges beyond the limit are
/// dropped. Unlike a solution with all edges, it is never bent by the false ones.
///
/// Leaves the problem at the solution over the set and returns one flag an edge; nothing where the
/// trusted edges do not determine all poses, or an information matrix is singular.
template <class Chart>
std::optional<std::vector<bool>> grow_consensus(const PoseGraph& graph,
                                                const std::vector<bool>& trusted, double limit,
                                                int threads, PoseProblem<Chart>& problem);

}  // namespace hmt::graph
