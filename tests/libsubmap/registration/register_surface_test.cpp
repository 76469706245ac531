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

TEST(RegisterSurface, LetsThePriorDecideAlongACorridor) {
  const test::Laser laser{.noise_m = 0.01};
  const Surface a = seen_from(test::corridor(), Pose{}, laser, 1);
  const Surface b = seen_from(test::corridor(), Pose::planar(0.3, 0.1, 0.05), laser, 2);
  RegistrationOptions options;
  options.prior = PosePrior{Pose::planar(0.3, 0, 0), Matrix6d::Zero()};
  options.prior->information.diagonal() << 1e4, 1e2, 0, 0, 0, 1e2;
  const Registration found = register_surface(b, target_of(a), Pose{}, options);
  EXPECT_NEAR(found.T_target_source.translation.x(), 0.3, 0.01);
  EXPECT_NEAR(found.T_target_source.translation.y(), 0.1, 0.01);
  EXPECT_NEAR(found.T_target_source.yaw_rad(), 0.05, 0.005);
}

// Three planes that meet at a right angle, seen as clouds: all six unknowns.
// Walls that fit already make outliers of a step in one of them, unless it has a scale of its own.
TEST(RegisterSurface, FollowsTheLittleThatStandsAcrossACorridor) {
  const std::vector<test::Wall> walls{
      {{-200, -1}, {200, -1}}, {{-200, 1.4}, {6, 1.4}}, {{6, 1.4}, {6, 1}}, {{6, 1}, {200, 1}}};
  const test::Laser laser{.noise_m = 0.005};
  const Surface a = seen_from(walls, Pose{}, laser, 1), b = seen_from(walls, Pose{}, laser, 2);
  const RegistrationTarget::Placed placed[] = {{Pose{}, &a}, {Pose{}, &b}};
  const Surface source = seen_from(walls, Pose::planar(0.25, 0, 0), laser, 3);
  RegistrationOptions options;
  options.scale_across = true;
  const Registration found = register_surface(source, RegistrationTarget(placed), Pose{}, options);
  EXPECT_NEAR(found.T_target_source.translation.x(), 0.25, 0.02);
}

TEST(RegisterSurface, FindsTheOffsetBetweenTwoCloudsOfACorner) {
  const auto cloud = [](const Pose& T_world_robot, float shift) {
    Observation observation;
    observation.readings.push_back(test::empty_reading(0.02));
    const Pose T_robot_world = T_world_robot.inverse();
    for (int i = 0; i < 30; ++i)
      for (int j = 0; j < 30; ++j) {
        const double u = 0.1 * i + shift, v = 0.1 * j + shift;
        for (const Eigen::Vector3d& p :
             {Eigen::Vector3d(u, v, 0), Eigen::Vector3d(u, 0, v), Eigen::Vector3d(0, u, v)})
          observation.readings[0].points_sensor.push_back((T_robot_world * p).cast<float>());
      }
    return make_surface(observation);
  };
  const Pose T_world_a{{1.5, 1.5, 1.5}, Eigen::Quaterniond::Identity()};
  Vector6d offset;
  offset << 0.1, -0.05, 0.08, 0.05, -0.04, 0.06;
  const Pose T_a_b = boxplus(Pose{}, offset);
  const Surface a = cloud(T_world_a, 0.0F), b = cloud(T_world_a * T_a_b, 0.03F);
  RegistrationOptions options;
  options.space = Space::se3;
  const Registration found = register_surface(b, target_of(a), Pose{}, options);
  const Vector6d error = boxminus(T_a_b, found.T_target_source);
  EXPECT_LT(error.norm(), 2e-3) << error.transpose();
  EXPECT_GT(found.information.diagonal().minCoeff(), 1e3);
}

TEST(RegisterSurface, SolvesForTheHeading) {
  const Surface a = seen_from(test::room(), Pose{}, {});
  const Surface b = seen_from(test::room(), Pose::planar(0, 0, -0.15), {});
  const Registration found = register_surface(b, target_of(a), Pose{}, {});
  EXPECT_NEAR(found.T_target_source.yaw_rad(), -0.15, 1e-4);
}

TEST(RegisterSurface, IsRepeatable) {
  const test::Laser laser{.noise_m = 0.02};
  const Surface a = seen_from(test::room(), Pose{}, laser, 1);
  const Surface b = seen_from(test::room(), Pose::planar(0.2, 0.1, 0.1), laser, 2);
  const Registration one = register_surface(b, target_of(a), Pose{}, {});
  const Registration two = register_surface(b, target_of(a), Pose{}, {});
  EXPECT_TRUE(one.T_target_source == two.T_target_source);
  EXPECT_TRUE(one.information == two.information);
}

TEST(RegisterSurface, FindsTheHeightByTheLittleGroundThatIsSeen) {
  std::mt19937 random(1);
  const test::Lidar lidar{.max_range_m = 30, .noise_m = 0.01};
  const Pose T_a_b = Pose::planar(1, 0.3, 0.2);
  const Surface a = make_surface(test::cloud(test::room(), 3, Pose{}, lidar, random));
  const Surface b = make_surface(test::cloud(test::room(), 3, T_a_b, lidar, random));
  const RegistrationTarget::Placed placed[] = {{Pose{}, &a}};
  Pose T_guess = T_a_b;
  T_guess.translation.z() = 0.3;
  RegistrationOptions options;
  options.space = Space::se3;
  const Registration result = register_surface(b, RegistrationTarget(placed), T_guess, options);
  EXPECT_EQ(result.termination, Registration::Termination::converged);
  EXPECT_LT(graph::boxminus(result.T_target_source, T_a_b).norm(), 0.005);
}

}  // namespace
}  // namespace hmt::submap
