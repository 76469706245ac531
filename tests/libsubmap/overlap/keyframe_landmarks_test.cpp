// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/overlap/keyframe_landmarks.hpp"

#include <gtest/gtest.h>

namespace hmt::submap {
namespace {

Sighting sighting(int keyframe, double x, double information) {
  Sighting s;
  s.keyframe = keyframe;
  s.p_keyframe = {x, 0, 0};
  s.information.diagonal() << information, information, 0;
  return s;
}

/// Two keyframes, observations 0 and 2; the landmark was seen from the first.
class TwoKeyframes : public testing::Test {
 protected:
  TwoKeyframes() {
    track_.keyframes = {{0, 0, 0, {}}, {1, 2, 1, {}}};
    observations_.resize(3);
  }
  const std::vector<LandmarkReading>& load(int64_t observation) {
    const ObservationVector store(observations_);
    const std::vector<Sighting> sightings = {sighting(0, 1, 3), sighting(0, 2, 1)};
    const std::vector<int64_t> names = {77};
    loaded_ = KeyframeLandmarks(track_, sightings, names, store).load(observation);
    return loaded_->landmark_readings;
  }

  Track track_;
  std::vector<Observation> observations_;
  std::shared_ptr<const Observation> loaded_;
};

TEST_F(TwoKeyframes, HoldTheMeanOfAllSightings) {
  ASSERT_EQ(load(0).size(), 1u);
  const Landmark& landmark = load(0)[0].landmarks.at(0);
  EXPECT_EQ(landmark.id, 0);
  EXPECT_DOUBLE_EQ(landmark.position_sensor.x(), 1.25);
  EXPECT_DOUBLE_EQ(landmark.covariance_sensor(0, 0), 0.25);
}

TEST_F(TwoKeyframes, WithoutScansLookedAndSawNothing) {
  ASSERT_EQ(load(2).size(), 1u);
  EXPECT_TRUE(load(2)[0].landmarks.empty());
}

TEST_F(TwoKeyframes, BesideScansThatSawNoneSayNothingOfLandmarks) {
  Reading scan;
  scan.points_sensor = {{1, 2, 0}};
  for (Observation& observation : observations_) observation.readings = {scan};
  EXPECT_TRUE(load(2).empty());
  EXPECT_EQ(loaded_->readings, std::vector<Reading>{scan});
  EXPECT_EQ(load(0).size(), 1u);
  EXPECT_EQ(loaded_->readings, std::vector<Reading>{scan});
}

TEST_F(TwoKeyframes, AreTheOnlyObservations) {
  EXPECT_THROW(load(1), InputError);
}

}  // namespace
}  // namespace hmt::submap
