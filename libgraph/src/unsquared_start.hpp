// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "pose_problem.hpp"

namespace hmt::graph {

/// r^T Omega r of every edge at poses of (nearly) least unsquared deviations, by iteratively
/// reweighted chordal relaxation.
///
/// The sum over edges of |r|_Omega, not of its square, pulls with the same force however far an
/// edge is off, so false edges that contradict each other cancel, and a place that more true edges
/// hold than false ones pull at stays put [Casafranca 2013; Carlone 2018]. At first only rotations
/// count, at the end powers of the deviation below one. Trusted edges keep their weight.
template <class Chart>
std::vector<double> unsquared_deviations(const PoseGraph& graph, const std::vector<bool>& trusted,
                                         double limit, PoseProblem<Chart>& problem);

}  // namespace hmt::graph
