// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "seen_through.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace hmt::submap {
namespace {

/// A wall x = `at_m` of points a decimetre apart, seen from the origin.
Surface wall(double at_m) {
  Surface surface;
  for (int k = -20; k <= 20; ++k) {
    surface.points_robot.emplace_back(at_m, 0.1 * k, 0);
    surface.normals_robot.emplace_back(-1, 0, 0);
    surface.sigma_m.push_back(0.01);
    surface.normal_sigma_rad.push_back(0.01);
    surface.spacing_m.push_back(0.1);
  }
  return surface;
}

RegistrationTarget target_of(const Surface& surface) {
  const RegistrationTarget::Placed placed[] = {{Pose{}, &surface}};
  return RegistrationTarget(placed);
}

TEST(SeenThrough, NothingOfWhatIsSeenAgain) {
  EXPECT_EQ(seen_through_share(wall(3), target_of(wall(3)), Pose{}), 0);
}

TEST(SeenThrough, AllOfAWallThatTheBeamsPass) {
  EXPECT_EQ(seen_through_share(wall(5), target_of(wall(3)), Pose{}), 1);
}

TEST(SeenThrough, NothingOfAWallBehindTheOneThatIsMeasured) {
  EXPECT_EQ(seen_through_share(wall(3), target_of(wall(5)), Pose{}), 0);
}

TEST(SeenThrough, NothingOfAWallOutOfView) {
  EXPECT_EQ(seen_through_share(wall(3), target_of(wall(3)), Pose::planar(0, 0, 3.1)), 0);
}

TEST(SeenThrough, NothingOfAWallThatTheBeamsGraze) {
  // In a doorway: beams pass along the wall at 10 cm and end half a metre farther, 2 cm behind it.
  Surface along;
  Surface beyond;
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d p(1 + 0.1 * k, 0.1, 0);
    for (const auto& [surface, share] : {std::pair(&along, 1.0), std::pair(&beyond, 1.4)}) {
      surface->points_robot.push_back(share * p);
      surface->normals_robot.emplace_back(0, -1, 0);
      surface->sigma_m.push_back(0.01);
      surface->normal_sigma_rad.push_back(0.01);
      surface->spacing_m.push_back(0.1);
    }
  }
  EXPECT_EQ(seen_through_share(beyond, target_of(along), Pose{}), 0);
}

double standing_in_view(const Surface& source, const Surface& seen) {
  const RegistrationTarget::Placed placed[] = {{Pose{}, &seen}};
  return standing_in_view_share(source, placed, Pose{});
}

// Both walls reach from y = -2 to 2: of the nearer one 25 points of 41 are before the other.
TEST(StandingInView, AllOfAWallBeforeTheOneThatWasSeen) {
  EXPECT_DOUBLE_EQ(standing_in_view(wall(3), wall(5)), 25.0 / 41);
}

TEST(StandingInView, NothingOfWhatIsSeenAgainOrHidden) {
  EXPECT_EQ(standing_in_view(wall(3), wall(3)), 0);
  EXPECT_EQ(standing_in_view(wall(5), wall(3)), 0);
}

TEST(StandingInView, NothingOutOfView) {
  const Surface seen = wall(5), source = wall(3);
  const RegistrationTarget::Placed placed[] = {{Pose{}, &seen}};
  EXPECT_EQ(standing_in_view_share(source, placed, Pose::planar(0, 0, 3.1)), 0);
  EXPECT_EQ(standing_in_view_share(Surface{}, placed, Pose{}), 0);
}

TEST(StandingInView, OneOfTwoViewsIsEnough) {
  const Surface near = wall(2), far = wall(5), source = wall(3);
  const RegistrationTarget::Placed placed[] = {{Pose{}, &near}, {Pose{}, &far}};
  EXPECT_DOUBLE_EQ(standing_in_view_share(source, placed, Pose{}), 25.0 / 41);
}

}  // namespace
}  // namespace hmt::submap
