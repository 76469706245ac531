// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace hmt::graph {

/// Probability that a chi-squared variable with `dof` >= 1 degrees of freedom exceeds `x`.
double chi_squared_survival(int dof, double x);

/// The x that a chi-squared variable with `dof` >= 1 degrees of freedom stays below with the given
/// probability in (0, 1). Throws InputError outside these ranges.
double chi_squared_quantile(int dof, double probability);

}  // namespace hmt::graph
