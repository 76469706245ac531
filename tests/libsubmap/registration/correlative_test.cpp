// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/correlative.hpp"

#include <gtest/gtest.h>

#include "scene.hpp"

namespace hmt::submap {
namespace {

Surface seen_from(const Pose& T_world_robot, unsigned seed) {
  std::mt19937 random(seed);
  return make_surface(test::scan(test::room(), T_world_robot, {.noise_m = 0.01}, random));
}

RegistrationTarget target_of(const Surface& surface) {
  const RegistrationTarget::Placed placed{Pose{}, &surface};
  return RegistrationTarget({&placed, 1});
}

TEST(CorrelativeSearch, FindsAPoseThatIsFarFromTheGuess) {
  const Pose T_a_b = Pose::planar(1.1, -0.7, 0.6);
  const RegistrationTarget target = target_of(seen_from(Pose{}, 1));
  const Surface b = seen_from(T_a_b, 2);
  const auto matches = correlative_search(b, target, Pose{}, {1.5, 1.0}, 3);
  ASSERT_FALSE(matches.empty());
  EXPECT_LT((matches[0].T_target_source.translation - T_a_b.translation).norm(), 0.1);
  EXPECT_NEAR(matches[0].T_target_source.yaw_rad(), 0.6, 0.03);
  EXPECT_GT(matches[0].score, 0.6);
  const Registration refined = register_surface(b, target, matches[0].T_target_source, {});
  EXPECT_LT((refined.T_target_source.translation - T_a_b.translation).norm(), 0.02);
}

TEST(CorrelativeSearch, GivesBothPosesOfARoomThatLooksTheSameTurnedAround) {
  const std::vector<test::Wall> walls{
      {{-4, -3}, {4, -3}}, {{4, -3}, {4, 3}}, {{4, 3}, {-4, 3}}, {{-4, 3}, {-4, -3}}};
  std::mt19937 random(1);
  const test::Laser all_around{.beams = 360, .field_of_view_rad = 6.26, .noise_m = 0.01};
  const Surface room = make_surface(test::scan(walls, Pose{}, all_around, random));
  const auto matches = correlative_search(room, target_of(room), Pose{}, {1.0, 3.2}, 2);
  ASSERT_EQ(matches.size(), 2u);
  EXPECT_GE(matches[0].score, matches[1].score);
  EXPECT_GT(matches[1].score, 0.95 * matches[0].score);
  const double apart_rad =
      matches[0].T_target_source.yaw_rad() - matches[1].T_target_source.yaw_rad();
  EXPECT_NEAR(std::abs(graph::wrap_angle(apart_rad)), std::numbers::pi, 0.05);
}

TEST(CorrelativeSearch, FindsNothingInNothing) {
  const Surface empty, room = seen_from(Pose{}, 1);
  EXPECT_TRUE(correlative_search(empty, target_of(room), Pose{}, {}, 3).empty());
  EXPECT_TRUE(correlative_search(room, target_of(empty), Pose{}, {}, 3).empty());
}

}  // namespace
}  // namespace hmt::submap
