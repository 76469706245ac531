// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "pose_problem.hpp"

namespace hmt::graph {

/// A set of edges that agree.
struct Consensus {
  std::vector<bool> accepted;  ///< one flag an edge
  /// chi2 up to which an edge that is not in the set might still belong to it: beyond the noise as
  /// it is seen, at most the limit.
  double limit_of_others = 0;
  bool guessed = false;  ///< the trusted edges do not determine all poses; see grow_consensus()
};

/// A set of edges that agree, grown from the trusted ones: each round predicts the error of every
/// other edge with the covariance of the present solution, S = cov(T_from_to) + information^-1, and
/// accepts those with r^T S^-1 r <= `limit` times the scale of the noise (chi2 by its degrees of
/// freedom, at most 1), beginning with the edges that agree best and whose acceptance says most:
/// where a false edge, placed anywhere in the map, would pass with the least probability. Then the
/// graph is solved again, which sharpens the predictions, and accepted edges beyond the limit are
/// dropped. Unlike a solution with all edges, it is never bent by the false ones.
///
/// Where the trusted edges do not determine all poses (several drives, no odometry), the set grows
/// from them and the edges that least unsquared deviations doubt least. What one mistake may then
/// hold in the wrong place (a single edge, or some beside each other) is joined anew wherever a
/// cycle over such pieces closes that says more, until nothing changes.
///
/// Leaves the problem at the solution over the set; nothing where an information matrix is singular
/// or there are points.
template <class Chart>
std::optional<Consensus> grow_consensus(const PoseGraph& graph, const std::vector<bool>& trusted,
                                        double limit, int threads, PoseProblem<Chart>& problem);

}  // namespace hmt::graph
