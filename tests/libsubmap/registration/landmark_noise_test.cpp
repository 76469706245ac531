// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hmt::submap {
namespace {

Observation sees(int64_t index, const Pose& T_odom_robot, int64_t name, const Eigen::Vector3d& p) {
  Observation observation;
  observation.index = index;
  observation.stamp_s = static_cast<double>(index);
  observation.T_odom_robot = T_odom_robot;
  observation.landmark_readings.resize(1);
  Landmark landmark;
  landmark.id = name;
  landmark.position_sensor = p;
  observation.landmark_readings.front().landmarks = {landmark};
  return observation;
}

const Matrix6d& motion(const Observation& observation) {
  return *observation.motion_covariance;
}

TEST(LandmarkNoise, IsOfRangeAlongTheSightAndOfBearingAcrossIt) {
  const auto log = with_noise({sees(0, Pose{}, 5, {4, 0, 0})}, Space::se2, {});
  const Eigen::Matrix3d& covariance = log[0].landmark_readings[0].landmarks[0].covariance_sensor;
  EXPECT_NEAR(covariance(0, 0), 0.1 * 0.1 + 0.2 * 0.2, 1e-12);
  EXPECT_NEAR(covariance(1, 1), 0.08 * 0.08, 1e-12);
  EXPECT_EQ(covariance(2, 2), 0);
  EXPECT_NEAR(motion(log[0])(0, 0), 1e-6, 1e-12);  // at rest
}

TEST(LandmarkNoise, SightingsOfOneViewCountAsOneAndThoseOfAnotherDoNot) {
  const TrackOptions options;
  const Pose away = Pose::planar(5 * options.keyframe_distance_m, 0, 0);
  const auto log = with_noise({sees(0, Pose{}, 5, {4, 0, 0}), sees(1, Pose{}, 5, {4, 0, 0}),
                               sees(2, Pose{}, 6, {4, 0, 0}), sees(3, away, 5, {4, 0, 0})},
                              Space::se2, options);
  const auto variance = [&log](size_t k) {
    return log[k].landmark_readings[0].landmarks[0].covariance_sensor(0, 0);
  };
  EXPECT_NEAR(variance(0), 2 * variance(2), 1e-12);
  EXPECT_EQ(variance(0), variance(1));
  EXPECT_EQ(variance(3), variance(2));
}

TEST(LandmarkNoise, LeavesWhatTheLogTells) {
  Observation told = sees(0, Pose{}, 5, {4, 0, 0});
  told.landmark_readings[0].landmarks[0].covariance_sensor = Eigen::Matrix3d::Identity();
  told.motion_covariance = Matrix6d::Identity();
  const auto log = with_noise({told, told}, Space::se2, {});
  EXPECT_EQ(log[1], told);
}

TEST(LandmarkNoise, FreesOdometryOfWhatItDoesWrongAlways) {
  // Ten rounds of 2 m radius among four landmarks; wheels that are four percent too small.
  constexpr double kTooLong = 1.04;
  std::vector<Observation> log;
  Pose T_odom_robot;
  Pose T_world_robot;
  const Pose step = Pose::planar(0.2, 0, 0.1);
  const Pose told = Pose::planar(0.2 * kTooLong, 0, 0.1);
  for (int k = 0; k < 630; ++k) {
    const double angle = std::numbers::pi / 2 * (k % 4);
    const Eigen::Vector3d p_world(4 * std::cos(angle), 2 + 4 * std::sin(angle), 0);
    log.push_back(sees(k, T_odom_robot, k % 4, T_world_robot.inverse() * p_world));
    T_odom_robot = T_odom_robot * told;
    T_world_robot = T_world_robot * step;
  }
  const auto freed = with_noise(log, Space::se2, {});
  const Pose found = graph::relative_pose(freed[10].T_odom_robot, freed[11].T_odom_robot);
  EXPECT_NEAR(found.translation.norm() / step.translation.norm(), 1, 0.01);
  EXPECT_NEAR(found.yaw_rad(), 0.1, 0.001);
}

}  // namespace
}  // namespace hmt::submap
