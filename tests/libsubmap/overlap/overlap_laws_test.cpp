// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// What holds for the overlap of all sensors alike.

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "hall.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "walls.hpp"

namespace hmt::submap {
namespace {

/// What a robot with certain sensors senses at a pose, and how steadily its overlap changes.
struct Robot {
  std::string name;
  bool has_scanner = false;
  int lidar_columns = 0;
  bool has_landmarks = false;
  /// Of the overlap when the robot moves by 8 mm: one of a few landmarks, or the far end of a wall.
  double largest_step = 0;
  double frame_error = 0;  ///< of the graph's weights when the world is moved

  Observation sense(const Pose& T_world_robot, unsigned seed) const;
};

LandmarkReading landmarks_of_a_hall(const Pose& T_world_robot, unsigned seed) {
  LandmarkReading reading;
  reading.sensor = 7;
  reading.T_robot_sensor = Pose::planar(0.2, 0.1, 0.3);
  std::mt19937 places(5), random(seed);
  std::uniform_real_distribution<double> x(-20, 60), y(-6, 7), z(-1, 3);
  std::normal_distribution<double> noise(0, 0.03);
  const Pose T_sensor_world = (T_world_robot * reading.T_robot_sensor).inverse();
  for (int i = 0; i < 120; ++i) {
    const Eigen::Vector3d p_world(x(places), y(places), z(places));
    const Eigen::Vector3d p = T_sensor_world * p_world;
    if (p.norm() > 10) continue;
    Landmark landmark;
    if (i % 4 == 0) landmark.id = i;
    landmark.position_sensor = p + Eigen::Vector3d(noise(random), noise(random), noise(random));
    landmark.covariance_sensor = 9e-4 * Eigen::Matrix3d::Identity();
    if (i % 3 == 0) landmark.descriptor = {static_cast<float>(i), static_cast<float>(i * i % 7)};
    reading.landmarks.push_back(landmark);
  }
  return reading;
}

Observation Robot::sense(const Pose& T_world_robot, unsigned seed) const {
  Observation observation;
  if (has_scanner) {
    const std::vector<test::Wall> pillars = {{{-5, 3}, {-4, 3}}, {{6, -3.5}, {7, -3.5}}};
    std::vector<test::Wall> walls = test::room(-20, -6.3, 60, 7.2);
    walls.insert(walls.end(), pillars.begin(), pillars.end());
    observation.readings.push_back(test::scan_walls(walls, T_world_robot));
  }
  if (lidar_columns > 0) {
    observation.readings.push_back(test::cloud_of_a_hall(T_world_robot, 24, lidar_columns));
    observation.readings.back().sensor = 3;
  }
  if (has_landmarks) {
    observation.landmark_readings.push_back(landmarks_of_a_hall(T_world_robot, seed));
  }
  return observation;
}

class OverlapLaws : public testing::TestWithParam<Robot> {
 protected:
  double overlap(const Observation& a, const Observation& b, const Pose& T_a_b) const {
    return observation_overlap(a, b, T_a_b, covariance(), OverlapOptions{});
  }
  static Matrix6d covariance() {
    Matrix6d covariance = Matrix6d::Zero();
    covariance.diagonal() << 4e-3, 2e-3, 1e-4, 1e-6, 1e-6, 1e-4;
    covariance(0, 5) = covariance(5, 0) = 3e-4;
    return covariance;
  }
  std::vector<Pose> poses() const {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> x(0, 12), y(-2, 2), heading(-3, 3);
    std::vector<Pose> poses;
    for (int i = 0; i < 6; ++i)
      poses.push_back(Pose::planar(x(random), y(random), heading(random)));
    return poses;
  }
  std::vector<Observation> observations() const {
    std::vector<Observation> observations;
    for (const Pose& T : poses()) {
      observations.push_back(GetParam().sense(T, static_cast<unsigned>(observations.size())));
      observations.back().index = static_cast<int64_t>(observations.size()) - 1;
    }
    return observations;
  }
};

TEST_P(OverlapLaws, IsOneWithItself) {
  for (const Observation& o : observations()) {
    EXPECT_EQ(observation_overlap(o, o, {}, Matrix6d::Zero(), OverlapOptions{}), 1.0);
  }
}

TEST_P(OverlapLaws, IsSymmetricAndInTheUnitInterval) {
  const auto seen = observations();
  const auto at = poses();
  int partial = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    for (size_t j = i + 1; j < seen.size(); ++j) {
      const Pose T_i_j = relative_pose(at[i], at[j]);
      const double there = overlap(seen[i], seen[j], T_i_j);
      const double back =
          observation_overlap(seen[j], seen[i], T_i_j.inverse(),
                              graph::inverse_covariance(T_i_j, covariance()), OverlapOptions{});
      EXPECT_NEAR(there, back, 2e-3) << i << " " << j;
      EXPECT_GE(there, 0.0);
      EXPECT_LE(there, 1.0);
      if (there > 0.05 && there < 0.95) ++partial;
    }
  }
  EXPECT_GT(partial, 5);
}

TEST_P(OverlapLaws, DoesNotChangeWhenBothMoveTogether) {
  const auto seen = observations();
  const auto at = poses();
  std::vector<Keyframe> keyframes;
  std::vector<Pose> moved;
  const Pose T_new_world{{300, -20, 5}, Eigen::Quaterniond(0.8, 0.1, -0.2, 0.5).normalized()};
  for (size_t i = 0; i < at.size(); ++i) {
    keyframes.push_back({static_cast<int>(i), static_cast<int64_t>(i), 0, at[i]});
    moved.push_back(T_new_world * at[i]);
  }
  const auto omega = overlap_graph(
      keyframes, moved, [](int, int) { return std::optional(covariance()); },
      ObservationVector(seen), OverlapOptions{}, submap::Run{});
  for (int i = 0; i < omega.num_nodes(); ++i) {
    for (int j = i + 1; j < omega.num_nodes(); ++j) {
      const auto a = static_cast<size_t>(i), b = static_cast<size_t>(j);
      const double pair = overlap(seen[a], seen[b], relative_pose(at[a], at[b]));
      EXPECT_NEAR(omega.weight(i, j), pair, GetParam().frame_error) << i << " " << j;
    }
  }
}

TEST_P(OverlapLaws, ChangesLittleWithASmallMotion) {
  const Observation a = GetParam().sense(Pose{}, 1);
  const Observation b = GetParam().sense(Pose::planar(0.5, 0.2, 0.4), 2);
  // Sideways onto the true pose, 8 mm a step.
  double last = overlap(a, b, Pose::planar(0.5, 1.0, 0.4)), least = last;
  for (int step = 1; step <= 100; ++step) {
    const double next = overlap(a, b, Pose::planar(0.5, 1.0 - 0.008 * step, 0.4));
    EXPECT_NEAR(next, last, GetParam().largest_step) << step;
    last = next;
    least = std::min(least, last);
  }
  EXPECT_GT(last, least + 0.05);
}

INSTANTIATE_TEST_SUITE_P(Sensors, OverlapLaws,
                         testing::Values(Robot{"scanner", true, 0, false, 0.1, 0.01},
                                         Robot{"lidar", false, 40, false, 0.03, 0.01},
                                         Robot{"dense_lidar", false, 400, false, 0.01, 0.06},
                                         Robot{"landmarks", false, 0, true, 0.15, 0.01},
                                         Robot{"all", true, 40, true, 0.06, 0.01}),
                         [](const auto& robot) { return robot.param.name; });

}  // namespace
}  // namespace hmt::submap
