// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>

#include "csr_graph.hpp"

namespace hmt::graph {

/// Cholesky factor of L + shift I, with L = I - D^{-1/2} Omega D^{-1/2} the normalized Laplacian of
/// a connected group of at least two nodes. Dense for small groups, CHOLMOD beyond.
class LaplacianFactor {
 public:
  virtual ~LaplacianFactor() = default;
  /// x = (L + shift I)^-1 b; `x` and `b` must not be the same memory.
  virtual void solve(Eigen::Ref<const Eigen::VectorXd> b, Eigen::VectorXd& x) = 0;
};

/// Beyond these a factor is not computed: it would take too much memory or time, as estimated from
/// its pattern.
struct FactorLimits {
  double bytes = 1e9;
  double flops = 6e9;  ///< some seconds
};

/// Null where the factor would be beyond the limits or cannot be computed.
std::unique_ptr<LaplacianFactor> factorize_laplacian(const CsrGraph& graph, double shift,
                                                     const FactorLimits& limits = {});

/// y = L x.
void apply_laplacian(const CsrGraph& graph, const Eigen::VectorXd& x, Eigen::VectorXd& y);

}  // namespace hmt::graph
