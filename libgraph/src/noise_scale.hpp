// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace hmt::graph {

/// By what factor a set of chi2 values is larger than what its information matrices say: its
/// `share` quantile as a multiple of that of chi2 with `size` degrees of freedom; 0 for no values.
double scale_at(std::vector<double> chi2, double share, int size);

/// The value below the widest gap, in logarithms, of the values within [low, high]: the last one of
/// a tail before those that are of another kind. `high` where no gap is clear.
double below_widest_gap(std::vector<double> values, double low, double high);

}  // namespace hmt::graph
