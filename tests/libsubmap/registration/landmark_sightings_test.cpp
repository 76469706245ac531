// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_sightings.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace hmt::submap {
namespace {

Landmark landmark(int64_t name, double x, double y, double variance) {
  Landmark l;
  l.id = name;
  l.position_sensor = {x, y, 0};
  l.covariance_sensor.diagonal() << variance, 2 * variance, 0;
  return l;
}

Observation observation(int64_t index, std::vector<Landmark> landmarks, const Pose& T_odom = {}) {
  Observation o;
  o.index = index;
  o.T_odom_robot = T_odom;
  o.landmark_readings.push_back({1, Pose::planar(1, 0, 0), std::move(landmarks)});
  return o;
}

// The camera stands 1 m ahead of the robot, the robot 2 m to the left of its keyframe, turned to
// the left by a right angle.
TEST(LandmarkSightings, AreCarriedToTheKeyframe) {
  LandmarkSightings sightings(Space::se2, {});
  const TrackedObservation tracked{7, 0, 3, Pose::planar(0, 2, std::numbers::pi / 2)};
  sightings.add(observation(7, {landmark(40, 4, 1, 0.01)}), tracked, Matrix6d::Zero());
  const std::vector<Sighting> all = sightings.take();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].observation, 7);
  EXPECT_EQ(all[0].keyframe, 3);
  EXPECT_EQ(all[0].landmark, 0);
  EXPECT_TRUE(all[0].p_keyframe.isApprox(Eigen::Vector3d(-1, 7, 0)));
  // Variances 0.01 along the view, which is y of the keyframe, and 0.02 across.
  EXPECT_TRUE(
      all[0].information.isApprox(Eigen::Matrix3d(Eigen::Vector3d(50, 100, 0).asDiagonal()), 1e-9));
  EXPECT_EQ(sightings.names(), std::vector<int64_t>{40});
}

// A heading known to 0.1 rad blurs what is 5 m away by half a metre across.
TEST(LandmarkSightings, AreBlurredByThePose) {
  LandmarkSightings sightings(Space::se2, {});
  Matrix6d covariance = Matrix6d::Zero();
  covariance(5, 5) = 0.01;
  sightings.add(observation(0, {landmark(40, 4, 0, 0.01)}), {}, covariance);
  EXPECT_TRUE(sightings.take()[0].information.isApprox(
      Eigen::Matrix3d(Eigen::Vector3d(100, 1 / (0.02 + 0.25), 0).asDiagonal()), 1e-9));
}

TEST(LandmarkSightings, OfOneViewWithoutCovarianceCountAsOne) {
  const auto information = [](int times) {
    LandmarkSightings sightings(Space::se2, {});
    for (int k = 0; k < times; ++k)
      sightings.add(observation(k, {landmark(40, 4, 0, 0)}), {k, 0, 0, {}}, Matrix6d::Zero());
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Sighting& sighting : sightings.take()) sum += sighting.information;
    return sum;
  };
  EXPECT_GT(information(1)(0, 0), 0);
  EXPECT_TRUE(information(9).isApprox(information(1), 1e-9));
}

TEST(LandmarkSightings, KeepTheirPlaceAmongThoseWithoutAName) {
  LandmarkSightings sightings(Space::se2, {});
  sightings.add(observation(0, {landmark(kUnknownLandmark, 1, 0, 1), landmark(9, 2, 0, 1)}), {},
                Matrix6d::Zero());
  sightings.add(observation(1, {landmark(8, 1, 0, 1), landmark(9, 2, 0, 1)}), {}, Matrix6d::Zero());
  EXPECT_EQ(sightings.unnamed(), 1);
  EXPECT_EQ(sightings.names(), (std::vector<int64_t>{9, 8}));
  const std::vector<Sighting> all = sightings.take();
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].place, 1);
  EXPECT_EQ(all[0].landmark, 0);
  EXPECT_EQ(all[1].landmark, 1);
  EXPECT_EQ(all[2].landmark, 0);
}

}  // namespace
}  // namespace hmt::submap
