// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "bisection.hpp"
#include "csr_graph.hpp"
#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// Pieces that leave a group one after the other.
struct Peeling {
  std::vector<int> part;  ///< of every local node: 0 the rest, 1.. the pieces in their order
  int parts = 1;
  std::vector<Bisection> bisections;  ///< one a piece; the first is the one that was given
};

/// The accepted bisection `cut` of a small side from a large one, and those that would follow if it
/// were repeated: a star loses one leaf, a wheel of spokes one spoke at each bisection, and each of
/// them would take an eigenvector of all that is left. Here the pieces like the small side leave in
/// one pass, each where its own Ncut from what is left at its turn is below tau [Blanco 2009,
/// Table 1]: single nodes after a single node, the lightest first; otherwise the components, but
/// the largest, of the group without the nodes that the small side hangs on, smallest first. The
/// pass ends when half of the group's association has left: the next eigenvector may see something
/// better.
Peeling peel_pieces(const CsrGraph& graph, const SpectralCut& cut, double tau);

}  // namespace hmt::graph
