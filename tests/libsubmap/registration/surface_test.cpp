// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene.hpp"

namespace hmt::submap {
namespace {

Surface seen(const std::vector<test::Wall>& walls, const test::Laser& laser) {
  std::mt19937 random(1);
  return make_surface(test::scan(walls, Pose{}, laser, random));
}

TEST(MakeSurface, OfNothingIsEmpty) {
  EXPECT_EQ(make_surface(Observation{}).size(), 0u);
}

TEST(MakeSurface, NormalsOfAWallPointBackAtTheSensor) {
  const Surface wall = seen({{{2, -5}, {2, 5}}}, {});
  ASSERT_GT(wall.size(), 50u);
  for (size_t i = 0; i < wall.size(); ++i)
    if (!wall.normals_robot[i].isZero(0)) {
      EXPECT_NEAR(wall.normals_robot[i].x(), -1, 1e-4);
      EXPECT_NEAR(wall.normals_robot[i].y(), 0, 1e-3);
    }
}

TEST(MakeSurface, TakesTheNoiseFromTheWalls) {
  for (const double noise_m : {0.01, 0.03}) {
    Surface room = seen(test::room(), {.noise_m = noise_m});
    std::nth_element(room.sigma_m.begin(), room.sigma_m.begin() + 180, room.sigma_m.end());
    EXPECT_NEAR(room.sigma_m[180], noise_m, 0.3 * noise_m);
  }
}

// A post at 2 m in front of a wall at 6 m: the pixels in between are on neither.
TEST(MakeSurface, GivesMixedPixelsNoNormal) {
  Reading reading = test::empty_reading(0.01);
  const auto at = [](int beam, float range_m) {
    const float bearing = 0.01F * static_cast<float>(beam);
    return Eigen::Vector3f(range_m * std::cos(bearing), range_m * std::sin(bearing), 0);
  };
  for (int beam = -20; beam < 0; ++beam) reading.points_sensor.push_back(at(beam, 6));
  reading.points_sensor.push_back(at(0, 5));
  reading.points_sensor.push_back(at(1, 4));
  reading.points_sensor.push_back(at(2, 3));
  for (int beam = 3; beam < 20; ++beam) reading.points_sensor.push_back(at(beam, 2));
  Observation observation;
  observation.readings.push_back(reading);
  const Surface surface = make_surface(observation);
  for (const size_t mixed : {20u, 21u, 22u})
    EXPECT_TRUE(surface.normals_robot[mixed].isZero(0)) << mixed;
  EXPECT_FALSE(surface.normals_robot[10].isZero(0));
  EXPECT_FALSE(surface.normals_robot[30].isZero(0));
}

TEST(MakeSurface, UsesThePoseOfTheSensor) {
  std::mt19937 random(1);
  Observation observation = test::scan({{{2, -5}, {2, 5}}}, Pose{}, {}, random);
  observation.readings[0].T_robot_sensor = Pose::planar(0, 0, std::numbers::pi / 2);
  const Surface wall = make_surface(observation);
  EXPECT_NEAR(wall.points_robot[wall.size() / 2].y(), 2, 1e-4);
  EXPECT_NEAR(wall.normals_robot[wall.size() / 2].y(), -1, 1e-4);
}

TEST(MakeSurface, FitsPlanesToClouds) {
  Observation observation;
  observation.readings.push_back(test::empty_reading(0.02));
  for (int i = -10; i <= 10; ++i)
    for (int j = -10; j <= 10; ++j)
      observation.readings[0].points_sensor.emplace_back(0.1F * static_cast<float>(i),
                                                         0.1F * static_cast<float>(j), -1.5F);
  const Surface floor = make_surface(observation);
  const size_t middle = floor.size() / 2;
  EXPECT_NEAR((floor.normals_robot[middle] - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-6);
}

}  // namespace
}  // namespace hmt::submap
