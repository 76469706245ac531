// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "csr_graph.hpp"
#include "fiedler.hpp"

namespace hmt::graph {

/// The Fiedler pair of a connected group that is too large to factorize, in time and memory about
/// linear in its arcs: the group is coarsened until it can be solved, and the vector is carried
/// back level by level, improved on each by locally optimal conjugate gradients [Knyazev 2001] with
/// a multigrid cycle as preconditioner. One pair; its residual says how exact it is.
FiedlerPairs multilevel_fiedler(const CsrGraph& graph);

}  // namespace hmt::graph
