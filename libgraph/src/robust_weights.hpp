// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pose_problem.hpp"

namespace hmt::graph {

/// Weight in [0, 1] of an edge of error `chi2` under the surrogate of truncated least squares with
/// control `mu` and threshold `limit` [Yang 2020, Eq. 14]: mu -> 0 is convex, mu -> infinity is the
/// truncation itself.
double truncated_weight(double chi2, double limit, double mu);

/// Minimizes the sum of min(chi2, limit) over the factors that are not trusted plus chi2 over those
/// that are, `limit` the 99.9 % quantile of chi2, so one true factor in a thousand is lost; one
/// flag an edge, then one a point edge. Starts from a consensus (an edge beyond it has the limit of
/// Consensus). Where none can be grown, or from a guess only, also by graduated non-convexity [Yang
/// 2020, Sec. V] from the present placement; the lesser sum is kept.
template <class Chart>
SolveReport solve_gnc(const PoseGraph& graph, const std::vector<bool>& trusted, int max_iterations,
                      int threads, PoseProblem<Chart>& problem);

}  // namespace hmt::graph
