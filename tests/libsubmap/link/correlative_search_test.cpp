// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/correlative_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

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

Points seen_from(const Pose& T_map_query, const Points& points_map) {
  Points points_query;
  for (const Eigen::Vector2f& p : points_map)
    points_query.push_back(
        (T_map_query.inverse() * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>().cast<float>());
  return points_query;
}

double score_at(const CorrelativeGrid& map, const Points& points_query, const Pose& T_map_query) {
  double sum = 0;
  for (const Eigen::Vector2f& p : points_query)
    sum += map.value((T_map_query * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>());
  return sum / static_cast<double>(points_query.size());
}

TEST(CorrelativeSearch, FindsThePoseFarFromTheGuess) {
  const CorrelativeGrid map(l_shape(), 0.05, 0.1, 5);
  const Pose truth = Pose::planar(1.3, -2.1, 0.4);
  const CorrelativeWindow window{Pose::planar(-1.0, 1.0, 0.0), 4.0, 4.0, 0.7};
  const auto best = correlative_search(map, seen_from(truth, l_shape()), window, 0.0);
  ASSERT_TRUE(best);
  EXPECT_GT(best->score, 0.9);
  EXPECT_LT((best->T_map_query.translation - truth.translation).norm(), 0.1);
  EXPECT_NEAR(best->T_map_query.yaw_rad(), truth.yaw_rad(), 0.03);
}

TEST(CorrelativeSearch, EqualsTheExhaustiveSearch) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> place(-3.0F, 3.0F);
  Points points_map;
  Points points_query;
  for (int i = 0; i < 60; ++i) points_map.emplace_back(place(random), place(random));
  for (int i = 0; i < 20; ++i) points_query.emplace_back(place(random), place(random));
  const CorrelativeGrid map(points_map, 0.1, 0.1, 4);
  const CorrelativeWindow window{Pose::planar(0.21, -0.13, 0.3), 1.0, 0.7, 0.0};
  const auto best = correlative_search(map, points_query, window, 0.0);
  double highest = 0;
  for (int y = -7; y <= 7; ++y)
    for (int x = -10; x <= 10; ++x)
      highest = std::max(
          highest, score_at(map, points_query, Pose::planar(0.21 + 0.1 * x, -0.13 + 0.1 * y, 0.3)));
  ASSERT_TRUE(best);
  EXPECT_NEAR(best->score, highest, 1e-9);
}

TEST(CorrelativeSearch, ExclusionGivesTheRival) {
  // Two posts 3 m apart, the query sees one of them.
  const Points posts = {{0.05F, 0.05F}, {3.05F, 0.05F}};
  const CorrelativeGrid map(posts, 0.1, 0.1, 4);
  const Points one = {{0.0F, 0.0F}};
  const CorrelativeWindow window{Pose::planar(0.05, 0.05, 0.0), 4.0, 1.0, 0.0};
  const auto best = correlative_search(map, one, window, 0.0);
  ASSERT_TRUE(best);
  const auto rival =
      correlative_search(map, one, window, 0.0, CorrelativeExclusion{best->T_map_query, 1.0, 0.2});
  ASSERT_TRUE(rival);
  EXPECT_DOUBLE_EQ(best->score, rival->score);
  EXPECT_NEAR((best->T_map_query.translation - rival->T_map_query.translation).norm(), 3.0, 1e-6);
}

TEST(CorrelativeSearch, GivesNothingBelowTheFloorOrWithoutPoints) {
  const CorrelativeGrid map(l_shape(), 0.1, 0.1, 4);
  const CorrelativeWindow window{Pose::planar(0.0, 0.0, 0.0), 1.0, 1.0, 0.1};
  EXPECT_FALSE(correlative_search(map, Points{}, window, 0.0));
  EXPECT_FALSE(correlative_search(map, Points{{50.0F, 50.0F}}, window, 0.0));
  EXPECT_FALSE(correlative_search(map, l_shape(), window, 1.0));
}

}  // namespace
}  // namespace hmt::submap
