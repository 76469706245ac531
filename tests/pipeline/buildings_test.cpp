// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "building_run.hpp"

namespace hmt::test {
namespace {

// All ten buildings are in tests/benchmarks/buildings_benchmark.cpp. In this one registrations
// between visits once wandered along the corridor, by 0.7 m.
TEST(Buildings, ARingOfEqualRoomsIsClosedRightly) {
  const BuildingFigures figures = run_building({.world = "ring", .seed = 2, .laps = 2}, 2);
  EXPECT_EQ(figures.false_closures, 0);
  ASSERT_GT(figures.revisits, 100);
  EXPECT_GE(figures.closed, 0.95 * figures.revisits);
  EXPECT_LE(figures.ate_rmse_m, 0.05);
  // Means of chi2 with three degrees of freedom; far above, the covariances promise too much.
  EXPECT_LT(figures.submap_nees, 6);
  EXPECT_LT(figures.link_nees, 6);
}

}  // namespace
}  // namespace hmt::test
