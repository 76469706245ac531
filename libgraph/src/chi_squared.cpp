// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/chi_squared.hpp"

#include <boost/math/special_functions/gamma.hpp>
#include <string>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {

double chi_squared_survival(int dof, double x) {
  return x > 0 ? boost::math::gamma_q(dof / 2.0, x / 2) : 1;
}

double chi_squared_quantile(int dof, double probability) {
  if (dof < 1)
    throw InputError("chi-squared degrees of freedom are " + std::to_string(dof) +
                     "; they must be at least 1");
  if (!(probability > 0 && probability < 1))
    throw InputError("chi-squared probability is " + std::to_string(probability) +
                     "; it must lie between 0 and 1");
  return 2 * boost::math::gamma_p_inv(dof / 2.0, probability);
}

}  // namespace hmt::graph
