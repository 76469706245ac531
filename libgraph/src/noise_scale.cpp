// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "noise_scale.hpp"

#include <algorithm>
#include <cstddef>

#include "hmt/graph/chi_squared.hpp"

namespace hmt::graph {
namespace {

/// Ratio of chi2 that sets the false edges apart from the tail of the true ones.
constexpr double kClearGap = 2;

}  // namespace

double scale_at(std::vector<double> chi2, double share, int size) {
  if (chi2.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(chi2.size()));
  std::nth_element(chi2.begin(), chi2.begin() + rank, chi2.end());
  return chi2[static_cast<size_t>(rank)] / chi_squared_quantile(size, share);
}

double below_widest_gap(std::vector<double> values, double low, double high) {
  std::erase_if(values, [&](double value) { return value <= low || value >= high; });
  values.push_back(low);
  values.push_back(high);
  std::sort(values.begin(), values.end());
  size_t widest = 0;
  for (size_t k = 0; k + 1 < values.size(); ++k)
    if (values[k + 1] / values[k] > values[widest + 1] / values[widest]) widest = k;
  return values[widest + 1] > kClearGap * values[widest] ? values[widest] : high;
}

}  // namespace hmt::graph
