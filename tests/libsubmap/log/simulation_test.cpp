// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/log/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "log/simulation/floor_plan.hpp"
#include "log/simulation/laser_model.hpp"
#include "log/simulation/robot_path.hpp"
#include "log/simulation/wheel_odometry.hpp"

namespace hmt::submap {
namespace {

using Eigen::Vector2d;

Box box(double x0, double y0, double x1, double y1) {
  return {Vector2d(x0, y0), Vector2d(x1, y1)};
}

double length(const std::vector<Wall>& walls) {
  double sum = 0;
  for (const Wall& wall : walls) sum += (wall.to - wall.from).norm();
  return sum;
}

double distance(const Vector2d& p, const Wall& wall) {
  const Vector2d way = wall.to - wall.from;
  const double share = std::clamp((p - wall.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (wall.from + share * way - p).norm();
}

// +----+ +----+      Two rooms of 4 x 3 m and a doorway of 1 x 1 m between them: the outline is
// |    +-+    |      2 * 14 m less two doors of 1 m and plus the two sides of the doorway.
// |    +-+    |
// +----+ +----+
TEST(FloorPlan, WallsAreTheEdgeOfTheUnion) {
  FloorPlan plan;
  plan.free = {box(0, 0, 4, 3), box(5, 0, 9, 3), box(4, 1, 5, 2)};
  EXPECT_NEAR(length(walls(plan)), 28, 1e-12);
  plan.free.push_back(box(1, 1, 3, 2));  // adds nothing to the union
  EXPECT_NEAR(length(walls(plan)), 28, 1e-12);
  plan.furniture = {box(1, 1, 2, 2)};
  EXPECT_NEAR(length(walls(plan)), 32, 1e-12);
}

TEST(LaserModel, MeasuresARoomOfFourByTwo) {
  FloorPlan plan;
  plan.free = {box(-1, -1, 3, 1)};
  const LaserModel laser(walls(plan));
  const auto ahead = laser.distances(Pose{});
  ASSERT_EQ(ahead.size(), 181u);
  EXPECT_NEAR(ahead[0], 1, 1e-12);
  EXPECT_NEAR(ahead[90], 3, 1e-12);
  EXPECT_NEAR(ahead[180], 1, 1e-12);
  EXPECT_NEAR(ahead[45], std::sqrt(2), 1e-12);
  const auto left = laser.distances(Pose::planar(0, 0, std::numbers::pi / 2));
  EXPECT_NEAR(left[0], 3, 1e-12);
  EXPECT_NEAR(left[180], 1, 1e-12);
}

TEST(LaserModel, SeesThePartOfAWallThatBeginsBehindIt) {
  // The wall passes from ahead on the right to behind on the left, straight over the back.
  const LaserModel laser({{{0.5, -1}, {-5, 0.5}}});
  const auto distances = laser.distances(Pose{});
  EXPECT_NEAR(distances[0], 1 - 0.5 * 1.5 / 5.5, 1e-12);
  EXPECT_TRUE(std::isinf(distances[90]));
}

TEST(LaserModel, LeavesOutWhatAnotherWallHides) {
  const LaserModel laser({{{2, -1}, {2, 1}}, {{4, -9}, {4, 9}}});
  const auto distances = laser.distances(Pose{});
  EXPECT_NEAR(distances[90], 2, 1e-12);
  EXPECT_NEAR(distances[150], 4 / std::cos(std::numbers::pi / 3), 1e-9);
}

TEST(RobotPath, DrivesTurnsAndEnds) {
  RobotPath robot([](int) { return std::vector<Vector2d>{{0, 0}, {0, 7}, {-7, 7}}; }, 1);
  EXPECT_TRUE(robot.advance(10));  // 7 m
  EXPECT_LT(boxminus(robot.T_world_robot(), Pose::planar(0, 7, std::numbers::pi / 2)).norm(), 1e-9);
  EXPECT_TRUE(robot.advance(std::numbers::pi));  // turns left by 90 deg
  EXPECT_LT(boxminus(robot.T_world_robot(), Pose::planar(0, 7, std::numbers::pi)).norm(), 1e-9);
  EXPECT_FALSE(robot.advance(10.1));
}

TEST(WheelOdometry, StandsStillWithTheRobot) {
  Random random(3);
  WheelOdometry odometry(Pose::planar(3, 4, 1), random);
  EXPECT_EQ(odometry.measure(Pose::planar(3, 4, 1), random), Pose{});
}

TEST(Random, NormalHasItsMeanAndDeviation) {
  Random random(5);
  double sum = 0;
  double squares = 0;
  constexpr int kDraws = 100000;
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.normal(2);
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.03);
  EXPECT_NEAR(std::sqrt(squares / kDraws), 2, 0.03);
}

class Worlds : public testing::TestWithParam<std::string> {};

TEST_P(Worlds, KeepTheRobotInsideAndOffTheWalls) {
  const FloorPlan plan = make_floor_plan(GetParam(), 7);
  const auto all_walls = walls(plan);
  const SimulatedLog log = simulate({GetParam(), 7, 4});
  for (const Pose& T_world_robot : log.T_world_robot) {
    const Vector2d p_world = T_world_robot.translation.head<2>();
    const auto holds = [&](const Box& area) { return area.contains(p_world); };
    ASSERT_TRUE(std::ranges::any_of(plan.free, holds)) << p_world.transpose();
    ASSERT_FALSE(std::ranges::any_of(plan.furniture, holds)) << p_world.transpose();
    for (const Wall& wall : all_walls) ASSERT_GT(distance(p_world, wall), 0.3);
  }
}

TEST_P(Worlds, GiveScansThatFitTheTruth) {
  const auto all_walls = walls(make_floor_plan(GetParam(), 2));
  const SimulatedLog log = simulate({GetParam(), 2, 1});
  ASSERT_GT(log.observations.size(), 300u);
  for (size_t i = 0; i < log.observations.size(); i += 50)
    for (const Eigen::Vector3d& p_robot : points_in_robot(log.observations[i])) {
      const Vector2d p_world = (log.T_world_robot[i] * p_robot).head<2>();
      double nearest_m = 1e9;
      for (const Wall& wall : all_walls) nearest_m = std::min(nearest_m, distance(p_world, wall));
      ASSERT_LT(nearest_m, 0.07);  // 6 sigma and the rounding to centimetres
    }
}

TEST_P(Worlds, DriftInOdometryButNotInSteps) {
  const SimulatedLog log = simulate({GetParam(), 1, 1});
  const auto drift = [&](size_t from, size_t to) {
    const Pose truth = graph::relative_pose(log.T_world_robot[from], log.T_world_robot[to]);
    const Pose measured = graph::relative_pose(log.observations[from].T_odom_robot,
                                               log.observations[to].T_odom_robot);
    return (measured.translation - truth.translation).norm();
  };
  double farthest_m = 0;
  for (size_t i = 1; i < log.observations.size(); ++i) {
    ASSERT_LT(drift(i - 1, i), 0.1);
    farthest_m = std::max(farthest_m, drift(0, i));
  }
  EXPECT_GT(farthest_m, 0.3);
}

INSTANTIATE_TEST_SUITE_P(All, Worlds, testing::ValuesIn(simulated_worlds()),
                         [](const auto& world) { return world.param; });

TEST(Simulation, RepeatsItselfForOneSeedOnly) {
  const auto once = simulate({"rooms", 3, 1});
  const auto again = simulate({"rooms", 3, 1});
  const auto other = simulate({"rooms", 4, 1});
  EXPECT_EQ(once.observations, again.observations);
  EXPECT_NE(once.observations, other.observations);
}

TEST(Simulation, GoesOnWithTheSameScansInLaterLaps) {
  const auto one = simulate({"building", 1, 1});
  const auto two = simulate({"building", 1, 2});
  ASSERT_GT(two.observations.size(), 19 * one.observations.size() / 10);
  for (size_t i = 0; i < one.observations.size(); ++i)
    ASSERT_EQ(one.observations[i], two.observations[i]);
}

TEST(Simulation, NamesTheWorldsItKnows) {
  try {
    Simulation({"moon", 1, 1});
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'moon'; there are building corridor ring rooms"));
  }
  EXPECT_THROW(Simulation({"rooms", 1, 0}), InputError);
}

}  // namespace
}  // namespace hmt::submap
