// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/chi_squared.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {

double chi_squared_survival(int dof, double x) {
  if (!(x > 0)) return 1;
  // Q(1, x) and Q(2, x) in closed form, then Q(k + 2, x) = Q(k, x) + (x/2)^(k/2) e^(-x/2) /
  // Gamma(k/2 + 1); the added term follows from the last one by one factor.
  const double half = x / 2;
  const bool odd = dof % 2 == 1;
  double survival = odd ? std::erfc(std::sqrt(half)) : std::exp(-half);
  double term =
      odd ? 2 * std::exp(-half) * std::sqrt(half / std::numbers::pi) : half * std::exp(-half);
  for (int k = odd ? 1 : 2; k < dof; k += 2) {
    survival += term;
    term *= half / (k / 2.0 + 1);
  }
  return survival;
}

double chi_squared_quantile(int dof, double probability) {
  if (dof < 1)
    throw InputError("chi-squared degrees of freedom are " + std::to_string(dof) +
                     "; they must be at least 1");
  if (!(probability > 0 && probability < 1))
    throw InputError("chi-squared probability is " + std::to_string(probability) +
                     "; it must lie between 0 and 1");
  double low = 0;
  double high = dof;
  while (chi_squared_survival(dof, high) > 1 - probability) high *= 2;
  // Ends when the interval holds no further double.
  for (double middle = high / 2; middle > low && middle < high; middle = (low + high) / 2)
    (chi_squared_survival(dof, middle) > 1 - probability ? low : high) = middle;
  return high;
}

}  // namespace hmt::graph
