// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "csr_graph.hpp"

namespace hmt::graph {

/// Lowers the Ncut of a bisection by moving nodes across it, one at a time, through worse cuts to
/// better ones [Fiduccia 1982, on Eq. 1 instead of the cut]. Never raises it and empties no side.
///
/// `outside` holds the weight from each node to nodes that are not in `graph`; empty: none. It
/// counts in the cut and in the association of the side, so what is lowered is the two sides' share
/// of the k-way Ncut, cut(A)/assoc(A) + cut(B)/assoc(B). Returns by how much.
double refine_cut(const CsrGraph& graph, Sides& sides, const std::vector<double>& outside = {});

}  // namespace hmt::graph
