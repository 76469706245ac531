// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/register_surface.hpp"

#include <gtest/gtest.h>

#include "scene.hpp"

namespace hmt::submap {
namespace {

Surface seen_from(const std::vector<test::Wall>& walls, const Pose& T_world_robot,
                  const test::Laser& laser, unsigned seed = 1) {
  std::mt19937 random(seed);
  return make_surface(test::scan(walls, T_world_robot, laser, random));
}

RegistrationTarget target_of(const Surface& surface) {
  const RegistrationTarget::Placed placed{Pose{}, &surface};
  return RegistrationTarget({&placed, 1});
}

TEST(RegisterSurface, FindsTheOffsetBetweenTwoViewsOfARightAngle) {
  const test::Laser laser;
  const Pose T_a_b = Pose::planar(0.3, -0.2, 0.1);
  const Surface a = seen_from(test::right_angle(), Pose{}, laser);
  const Surface b = seen_from(test::right_angle(), T_a_b, laser);
  const Registration found = register_surface(b, target_of(a), Pose{}, {});
  EXPECT_EQ(found.termination, Registration::Termination::converged);
  EXPECT_LT((found.T_target_source.translation - T_a_b.translation).norm(), 1e-4);
  EXPECT_NEAR(found.T_target_source.yaw_rad(), 0.1, 1e-4);
  EXPECT_GT(found.inlier_fraction, 0.9);
}

TEST(RegisterSurface, KnowsNothingAlongACorridor) {
  const test::Laser laser{.noise_m = 0.01};
  const Surface a = seen_from(test::corridor(), Pose{}, laser, 1);
  const Surface b = seen_from(test::corridor(), Pose{}, laser, 2);
  const Registration found = register_surface(b, target_of(a), Pose{}, {});
  const Matrix6d& information = found.information;
  EXPECT_LT(information(0, 0), 1e-3 * information(1, 1));
  EXPECT_GT(information(1, 1), 1e4);
  EXPECT_GT(information(5, 5), 1e4);
}

TEST(RegisterSurface, EmptySurfacesGiveTheGuessAndNoInformation) {
  const Surface empty = make_surface(Observation{});
  const Surface room = seen_from(test::room(), Pose{}, {});
  const Pose guess = Pose::planar(1, 2, 0.3);
  for (const auto& [source, target] : {std::pair(empty, room), std::pair(room, empty)}) {
    const Registration found = register_surface(source, target_of(target), guess, {});
    EXPECT_EQ(found.termination, Registration::Termination::too_few_points);
    EXPECT_TRUE(found.T_target_source == guess);
    EXPECT_TRUE(found.information.isZero());
    EXPECT_EQ(found.inliers, 0);
  }
}

// Mean normalized estimation error squared over many noisy pairs: 3 for honest information.
TEST(RegisterSurface, InformationPredictsTheErrorsOfNoisyScans) {
  constexpr int kRuns = 100;
  const test::Laser laser{.beams = 181, .noise_m = 0.01};
  const Pose T_a_b = Pose::planar(0.25, 0.15, 0.2);
  double nees = 0;
  for (unsigned run = 0; run < kRuns; ++run) {
    const Surface a = seen_from(test::room(), Pose{}, laser, 2 * run + 1);
    const Surface b = seen_from(test::room(), T_a_b, laser, 2 * run + 2);
    const Registration found = register_surface(b, target_of(a), T_a_b, {});
    const Vector6d e = boxminus(T_a_b, found.T_target_source);
    nees += e.dot(found.information * e) / kRuns;
  }
  EXPECT_GT(nees, 1.0);
  EXPECT_LT(nees, 4.5);
}

}  // namespace
}  // namespace hmt::submap
