// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/submap/link/loop_search.hpp"

namespace hmt::submap {

/// Travel around the center that makes the map, and that makes the query. The query is the shorter
/// one, so that what it saw is in the map also where the two centers do not coincide.
inline constexpr double kMapReachM = 8.0;
inline constexpr double kQueryReachM = 5.0;

/// A pair of keyframes that is worth a search.
struct LoopProposal {
  int a = 0;
  int b = 0;
  Pose T_a_b;                              ///< predicted
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_a_b, tangent of Pose (frame b)
};

/// Pairs of places whose sensed regions may meet within the accumulated covariance: for each place
/// the few nearest ones of each earlier visit, as far as the track between them is not part of one
/// of the two patches and the pair is neither tied nor known well enough already. Ordered by (a,
/// b).
std::vector<LoopProposal> propose_loops(const LoopProblem& problem, std::span<const double> path_m,
                                        int threads);

}  // namespace hmt::submap
