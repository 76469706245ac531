// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "csr_graph.hpp"

namespace hmt::graph {

/// Smallest eigenpairs of the normalized Laplacian besides the null pair (0, D^{1/2} 1), in rising
/// order: column k of `z` belongs to lambda[k]. The first pair (lambda_2 and the Fiedler vector) is
/// converged, the others are as good as they came along.
struct FiedlerPairs {
  Eigen::VectorXd lambda;
  Eigen::MatrixXd z;    ///< unit columns, orthogonal to D^{1/2} 1
  double residual = 0;  ///< |L z - lambda z| of the first pair
};

/// At most `count` pairs of a connected group of at least two nodes. Small groups are solved
/// densely, others by shift-invert Lanczos from a fixed start vector.
FiedlerPairs fiedler_pairs(const CsrGraph& graph, int count);

}  // namespace hmt::graph
