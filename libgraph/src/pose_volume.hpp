// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>

namespace hmt::graph {

/// Logarithm of the volume of the unit ball in 3 or 6 dimensions.
inline double log_unit_ball(int size) {
  const double pi = std::numbers::pi;
  return std::log(size == 3 ? 4 * pi / 3 : pi * pi * pi / 6);
}

}  // namespace hmt::graph
