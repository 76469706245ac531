// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/graph/pose_graph.hpp"

namespace hmt::benchmarks {

struct PlainCeresResult {
  double chi2 = 0;
  double solve_s = 0;
  int iterations = 0;
};

/// What a user of Ceres writes from its examples: automatic differentiation, default options,
/// SPARSE_NORMAL_CHOLESKY, from the poses of the graph. The residual is ours, so both reach the
/// same optimum. Building the problem is part of solve_s.
PlainCeresResult solve_with_plain_ceres(const graph::PoseGraph& graph);

}  // namespace hmt::benchmarks
