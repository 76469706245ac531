// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/map/placed_observation.hpp"

#include <gtest/gtest.h>

#include "sample_map.hpp"

namespace hmt::submap {
namespace {

TEST(PlacedObservation, SubmapHasTheObservationsOfItsKeyframes) {
  HybridMap map = test::sample_map();
  map.submaps[0].T_submap_keyframe[0] = Pose::planar(5, 0, 0);
  const auto placed = observations_in_submap(map.track, map.submaps[0]);
  ASSERT_EQ(placed.size(), 2u);
  EXPECT_EQ(placed[0], (PlacedObservation{0, Pose::planar(5, 0, 0)}));
  EXPECT_EQ(placed[1].observation, 1);
  EXPECT_NEAR(placed[1].T_frame_robot.translation.x(), 6, 1e-12);
}

TEST(PlacedObservation, WorldHasAllOfThemInTheOrderOfTheLog) {
  const auto placed = observations_in_world(test::sample_map());
  ASSERT_EQ(placed.size(), 3u);
  EXPECT_EQ(placed[2].observation, 2);
  EXPECT_NEAR(placed[2].T_frame_robot.translation.x(), 2, 1e-12);
}

}  // namespace
}  // namespace hmt::submap
