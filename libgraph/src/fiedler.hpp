// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>

#include "csr_graph.hpp"
#include "laplacian_factor.hpp"

namespace hmt::graph {

/// Smallest eigenpairs of the normalized Laplacian besides the null pair (0, D^{1/2} 1), in rising
/// order: column k of `z` belongs to lambda[k].
struct FiedlerPairs {
  Eigen::VectorXd lambda;
  Eigen::MatrixXd z;    ///< unit columns, orthogonal to D^{1/2} 1; the largest entry is positive
  double residual = 0;  ///< |L z - lambda z| of the first pair
};

/// Solves one connected group of at least two nodes, which must outlive the solver.
class FiedlerSolver {
 public:
  explicit FiedlerSolver(const CsrGraph& graph);
  /// At most `count` pairs, one at least: the first is lambda_2 and the Fiedler vector. Small
  /// groups are solved densely, others by shift-invert Lanczos from a fixed start vector; groups
  /// that are too large to factorize by multilevel_fiedler, with one pair.
  FiedlerPairs pairs(int count);

 private:
  const CsrGraph& graph_;
  std::unique_ptr<LaplacianFactor> factor_;
};

/// Keeps the factorized matrix positive definite; far below lambda_2 of a chain of 10^5 nodes.
constexpr double kLanczosShift = 1e-10;

/// At most `count` pairs by the Lanczos process on the factor of L + kLanczosShift I; those that
/// converged, possibly none. The residual is not set.
FiedlerPairs lanczos_pairs(const CsrGraph& graph, LaplacianFactor& factor, int count);

/// Fixed pseudo-random numbers in [-1/2, 1/2].
Eigen::VectorXd start_vector(int n);

}  // namespace hmt::graph
