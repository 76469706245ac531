// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/graph/partition.hpp"

namespace hmt::benchmarks {

/// What a plain program does, as a yardstick: single-threaded recursion, Spectra's Lanczos with 20
/// vectors on CHOLMOD's factor of the normalized Laplacian + 1e-7 I with D^{1/2} 1 projected out,
/// the best threshold along the vector, no refinement and no second candidate. The graph must be
/// connected; so must be the sides of every cut, which the caller's graphs are.
struct PlainResult {
  int groups = 0;
  double top_ncut = 0;
};
PlainResult plain_recursion(const graph::WeightedGraph& graph, double tau);

}  // namespace hmt::benchmarks
