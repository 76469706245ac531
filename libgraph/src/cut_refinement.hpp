// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "csr_graph.hpp"

namespace hmt::graph {

/// Lowers the Ncut of a bisection by moving nodes across it, one at a time, through worse cuts to
/// better ones [Fiduccia 1982, on Eq. 1 instead of the cut]. Never raises it and empties no side.
void refine_cut(const CsrGraph& graph, Sides& sides);

}  // namespace hmt::graph
