// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "csr_graph.hpp"
#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// A bisection of one connected group with what is known about it.
struct SpectralCut {
  Sides sides;
  double ncut = 0;
  double lambda_2 = 0;
  double residual = 0;
};

Bisection report(const SpectralCut& cut);

/// Cuts `graph` along `y`: side 1 holds the nodes above the threshold [Blanco 2009, Sec. 2.2]. No
/// side is empty; ties on the vector go by the smaller node. Nothing where all of `y` is equal for
/// mean and sign, or where there is one node.
std::optional<Sides> threshold_cut(const CsrGraph& graph, const std::vector<double>& y,
                                   Threshold threshold);

/// The least Ncut that was found for a connected group. With `tau`: the first candidate below tau,
/// or nothing where none is. Candidates, each refined: the threshold of `options` on the Fiedler
/// vector, then other thresholds on it, then the next eigenvectors.
std::optional<SpectralCut> spectral_cut(const CsrGraph& graph, const PartitionOptions& options,
                                        std::optional<double> tau);

}  // namespace hmt::graph
