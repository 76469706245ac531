// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "noise_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hmt::graph {
namespace {

// With two degrees of freedom the quantile of p is -2 ln(1 - p).
TEST(NoiseScale, IsTheQuantileAsAMultipleOfThatOfChiSquared) {
  EXPECT_NEAR(scale_at({9, 1, 5, 3}, 0.5, 2), 5 / (2 * std::log(2.0)), 1e-9);
  EXPECT_NEAR(scale_at({9, 1, 5, 3}, 0.25, 2), 3 / (2 * std::log(4.0 / 3)), 1e-9);
}

TEST(NoiseScale, OfNoValuesIsZero) {
  EXPECT_EQ(scale_at({}, 0.5, 3), 0);
}

TEST(NoiseScale, GapIsTheWidestInLogarithms) {
  // 2 to 8 is a factor of 4, 8 to 15 is less than 2 in spite of the larger difference.
  EXPECT_EQ(below_widest_gap({15, 1.5, 8, 2}, 1, 16), 2);
}

TEST(NoiseScale, ValuesOutsideDoNotCount) {
  EXPECT_EQ(below_widest_gap({0.001, 3, 1e6}, 1, 4), 1);
}

TEST(NoiseScale, NoClearGapMeansTheUpperEnd) {
  EXPECT_EQ(below_widest_gap({1.5, 2, 3}, 1, 4), 4);
}

}  // namespace
}  // namespace hmt::graph
