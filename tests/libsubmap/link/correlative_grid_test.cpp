// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/correlative_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

using Points = std::vector<Eigen::Vector2f>;

/// An L of points 0.1 m apart: 4 m along x and 2 m along y.
Points l_shape() {
  Points points;
  for (int i = 0; i <= 40; ++i) points.emplace_back(0.1F * static_cast<float>(i), 0.0F);
  for (int i = 1; i <= 20; ++i) points.emplace_back(0.0F, 0.1F * static_cast<float>(i));
  return points;
}

TEST(CorrelativeGrid, IsOneAtAPointAndFallsAsTheGaussian) {
  const Points one = {{0.05F, 0.05F}};
  const CorrelativeGrid grid(one, 0.1, 0.1, 0);
  // The cells' centers lie 0, 0.1 and 0.4 m from the point: exp(0), exp(-1/2), beyond 3 sigma.
  const Eigen::Vector2d origin(0.05, 0.05);
  EXPECT_NEAR(grid.value(origin), 1.0, 1e-9);
  EXPECT_NEAR(grid.value(origin + Eigen::Vector2d(0.1, 0.0)), std::exp(-0.5), 0.5 / 255);
  EXPECT_EQ(grid.value(origin + Eigen::Vector2d(0.4, 0.0)), 0.0);
  EXPECT_EQ(grid.value(origin + Eigen::Vector2d(99.0, 0.0)), 0.0);
}

TEST(CorrelativeGrid, BoundIsTheLargestValueOfItsWindow) {
  const CorrelativeGrid grid(l_shape(), 0.1, 0.1, 3);
  for (int level = 1; level <= 3; ++level)
    for (int y = 0; y < 40; y += 3)
      for (int x = 0; x < 60; x += 3) {
        int largest = 0;
        for (int dy = 0; dy < 1 << level; ++dy)
          for (int dx = 0; dx < 1 << level; ++dx)
            largest = std::max(largest, grid.bound(0, x + dx, y + dy));
        EXPECT_EQ(grid.bound(level, x, y), largest) << level << " " << x << " " << y;
      }
}

TEST(CorrelativeGrid, WithoutPointsIsZero) {
  const CorrelativeGrid grid({}, 0.1, 0.1, 3);
  EXPECT_EQ(grid.value({0.0, 0.0}), 0.0);
  EXPECT_EQ(grid.bound(3, 0, 0), 0);
}

}  // namespace
}  // namespace hmt::submap
