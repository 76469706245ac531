// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace hmt::submap {

/// Random numbers that are the same with every standard library, which std::normal_distribution is
/// not.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  /// In (0, 1).
  double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Normal with mean 0 and this standard deviation [Box and Muller 1958].
  double normal(double sigma) {
    const double radius = std::sqrt(-2 * std::log(uniform()));
    return sigma * radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace hmt::submap
