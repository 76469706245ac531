// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "link/landmark_revisits.hpp"

#include <gtest/gtest.h>

#include "../registration/scene.hpp"

namespace hmt::submap {
namespace {

// One room is 6 m by 4 m, the other 12 m by 2 m; a robot stands in the middle of each.
std::vector<test::Wall> room(double x, double length, double width) {
  const Eigen::Vector2d a(x - length / 2, -width / 2), b(x + length / 2, -width / 2);
  const Eigen::Vector2d c(x + length / 2, width / 2), d(x - length / 2, width / 2);
  return {{a, b}, {b, c}, {c, d}, {d, a}};
}

constexpr double kHall = 100;  // where the other room is

/// Keyframes 0, 1 and 50 are in the room or the hall; the landmark brings them to one place.
class TwoVisits : public testing::Test {
 protected:
  LandmarkRevisits check(double x_first, double x_second, Space space = Space::se2) {
    std::vector<test::Wall> walls = room(0, 6, 4);
    for (const test::Wall& wall : room(kHall, 12, 2)) walls.push_back(wall);
    std::mt19937 random(1);
    Track track;
    track.space = space;
    std::vector<Observation> observations;
    for (int k = 0; k <= 50; ++k) {
      const Pose T_world_robot = Pose::planar(k < 50 ? x_first : x_second, 0, 0);
      observations.push_back(test::scan(walls, T_world_robot, {}, random));
      track.keyframes.push_back({k, k, 0.1 * k, {}});
    }
    std::vector<Pose> T_world_keyframe(51);
    T_world_keyframe[50] = T_world_second_;
    return check_revisits(track, T_world_keyframe, sightings_, ObservationVector(observations));
  }
  static Sighting sighting(int keyframe, int landmark) {
    Sighting s;
    s.keyframe = keyframe;
    s.landmark = landmark;
    return s;
  }

  // As the landmark has it, all of them stand within 10 cm of each other.
  Pose T_world_second_ = Pose::planar(0.1, 0.05, 0.02);
  // Landmark 3 twice on the first visit, once on the second; landmark 4 on the second alone.
  std::vector<Sighting> sightings_ = {sighting(0, 3), sighting(1, 3), sighting(50, 3),
                                      sighting(50, 4)};
};

TEST_F(TwoVisits, ToOnePlaceAreKept) {
  const LandmarkRevisits revisits = check(0, 0);
  EXPECT_EQ(revisits.contradicted, 0);
  EXPECT_EQ(revisits.kept, sightings_);
}

TEST_F(TwoVisits, ToTwoPlacesThatLookOtherwiseLoseTheShorterOne) {
  const LandmarkRevisits revisits = check(0, kHall);
  EXPECT_EQ(revisits.contradicted, 1);
  EXPECT_EQ(revisits.kept,
            (std::vector<Sighting>{sighting(0, 3), sighting(1, 3), sighting(50, 4)}));
  // Clouds look over what is in their way.
  EXPECT_EQ(check(0, kHall, Space::se3).kept, sightings_);
}

TEST_F(TwoVisits, FarFromEachOtherAreNotCompared) {
  T_world_second_ = Pose::planar(4, 0, 0);
  EXPECT_EQ(check(0, kHall).kept, sightings_);
}

TEST_F(TwoVisits, AreOneWithFewKeyframesBetween) {
  sightings_ = {sighting(0, 3), sighting(10, 3), sighting(20, 3)};
  EXPECT_EQ(check(0, kHall).kept, sightings_);
}

}  // namespace
}  // namespace hmt::submap
