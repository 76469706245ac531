// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "hmt/graph/pose_optimizer.hpp"

namespace ceres {
class Problem;
}

namespace hmt::graph {

/// What the minimizer did.
struct MinimizerReport {
  Termination termination = Termination::nothing_to_do;
  std::string message;
  int iterations = 0;
  double gradient_norm = 0;
  double cost = 0;  ///< sum of the squared residuals after their losses, no 1/2
};

/// Minimizes a least squares problem whose start is good, as that of a pose graph is: full
/// Gauss-Newton steps while each of them lowers the cost, Levenberg-Marquardt from the first one
/// that does not. Ends when the decrease that is left, extrapolated from the last two steps, is
/// below 1e-9 of the cost. On the calling thread alone: with more, Ceres sums the cost in the order
/// in which threads finish. `max_iterations` >= 1.
MinimizerReport minimize(ceres::Problem& problem, int max_iterations);

}  // namespace hmt::graph
