// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// Largest set of loop edges that agree pairwise [Mangelson 2018]: edges k and l agree if the cycle
/// from_k -> to_k -> to_l -> from_l -> from_k closes within the chi2 quantile `confidence`, with
/// the covariance of the two edges and that of the relative poses of the trajectory between their
/// ends.
///
/// `trajectory` holds the poses and the trusted edges (odometry); `loops` are the edges to be
/// judged. Returns one flag a loop. Each loop is compared with the 500 before and after it in the
/// order of `to`, so that time grows with the number of loops. Loops that conflicts tie together,
/// directly or through others, are judged on their own: exact maximum clique as long as the search
/// takes less than about a second, counted in branches, the largest clique found so far beyond;
/// ties by smaller index. Throws InputError where a loop is invalid or its information is singular.
std::vector<bool> pairwise_consistent_set(const PoseGraph& trajectory,
                                          std::span<const PoseGraphEdge> loops,
                                          double confidence = 0.99);

}  // namespace hmt::graph
