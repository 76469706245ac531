// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/thin_track.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hmt::submap {
namespace {

Matrix6d information(double xy) {
  Vector6d diagonal;
  diagonal << xy, xy, 0, 0, 0, 1e12;
  return diagonal.asDiagonal();
}

/// Six keyframes a metre apart along x, each with an observation half a metre behind it that hangs
/// on it. The world is turned to the left by 90 degrees.
///   0 - 1 - 2 - 3 - 4 - 5
Track straight_track() {
  Track track;
  for (int k = 0; k < 6; ++k) {
    track.keyframes.push_back({k, 2 * k, 1.0 * k, Pose::planar(k, 0, 0)});
    track.observations.push_back({2 * k, 1.0 * k, k, Pose{}});
    track.observations.push_back({2 * k + 1, k + 0.5, k, Pose::planar(-0.5, 0, 0)});
    if (k < 5)
      track.odometry.push_back(
          {k, k + 1, ConstraintKind::odometry, Pose::planar(1, 0, 0), information(100)});
  }
  return track;
}

std::vector<Pose> poses_in_world(int count) {
  std::vector<Pose> poses;
  for (int k = 0; k < count; ++k) poses.push_back(Pose::planar(0, k, M_PI / 2));
  return poses;
}

// 2 and 3 hang on 0; 5 is not placed yet.
const std::vector<int> kHost = {0, 1, 0, 0, 4};

TEST(ThinTrack, NumbersThoseThatStay) {
  EXPECT_EQ(numbers_of_kept(kHost, 6), (std::vector<int>{0, 1, -1, -1, 2, 3}));
}

TEST(ThinTrack, LeavesEveryObservationWhereItWas) {
  const Track before = straight_track();
  const Track after = thin_track(before, kHost, poses_in_world(5));
  ASSERT_EQ(after.keyframes.size(), 4u);
  EXPECT_EQ(after.keyframes[2].id, 2);
  EXPECT_EQ(after.keyframes[2].observation, before.keyframes[4].observation);
  ASSERT_EQ(after.observations.size(), before.observations.size());
  const std::vector<int> on = {0, 0, 1, 1, 0, 0, 0, 0, 2, 2, 3, 3};
  for (size_t k = 0; k < on.size(); ++k) {
    EXPECT_EQ(after.observations[k].keyframe, on[k]) << k;
    EXPECT_EQ(after.observations[k].observation, before.observations[k].observation);
  }
  // Observation 7 is half a metre behind keyframe 3, which is three metres ahead of keyframe 0.
  EXPECT_LT(graph::boxminus(after.observations[7].T_keyframe_robot, Pose::planar(2.5, 0, 0)).norm(),
            1e-12);
  EXPECT_EQ(after.observations[9].T_keyframe_robot, before.observations[9].T_keyframe_robot);
}

TEST(ThinTrack, JoinsTheOdometryOverThoseThatGo) {
  const Track after = thin_track(straight_track(), kHost, poses_in_world(5));
  ASSERT_EQ(after.odometry.size(), 3u);
  EXPECT_EQ(after.odometry[0], straight_track().odometry[0]);
  const Constraint& over = after.odometry[1];
  EXPECT_EQ(over.a, 1);
  EXPECT_EQ(over.b, 2);
  EXPECT_LT(graph::boxminus(over.T_a_b, Pose::planar(3, 0, 0)).norm(), 1e-12);
  // Three steps have three times the variance of one.
  EXPECT_NEAR(over.information(0, 0), 100.0 / 3, 1e-3);
  EXPECT_EQ(after.odometry[2].a, 2);
  EXPECT_EQ(after.odometry[2].b, 3);
}

TEST(ThinTrack, KeepsConstraintsAndLoopsBetweenThoseThatStay) {
  const Track track = straight_track();
  const Track after = thin_track(track, kHost, poses_in_world(5));
  const std::vector<int> number = numbers_of_kept(kHost, 6);
  std::vector<Constraint> constraints(track.odometry.begin(), track.odometry.begin() + 4);
  constraints.push_back(
      {0, 4, ConstraintKind::registration, Pose::planar(4, 0, 0), information(5)});
  constraints.push_back({0, 3, ConstraintKind::loop, Pose::planar(3, 0, 0), information(5)});
  const std::vector<Constraint> kept = thin_constraints(constraints, number, after, 3);
  // The odometry to keyframe 5 belongs to the next section.
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(kept[1], after.odometry[1]);
  EXPECT_EQ(kept[2].b, 2);
  EXPECT_EQ(kept[2].T_a_b, constraints[4].T_a_b);
  LoopCandidate stays, goes;
  stays.a = 1;
  stays.b = 4;
  goes.a = 1;
  goes.b = 3;
  const auto loops = thin_loops(std::vector{goes, stays}, number);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_EQ(loops[0].b, 2);
}

TEST(ThinTrack, RefusesAHostThatGoesItselfAndEndsThatDo) {
  const Track track = straight_track();
  const auto poses = poses_in_world(5);
  EXPECT_THROW(thin_track(track, std::vector{0, 1, 3, 0, 4}, poses), InputError);
  EXPECT_THROW(thin_track(track, std::vector{0, 1, 9, 3, 4}, poses), InputError);
  EXPECT_THROW(thin_track(track, std::vector{1, 1, 2, 3, 4}, poses), InputError);
  EXPECT_THROW(thin_track(track, std::vector{0, 1, 2, 3, 0}, poses), InputError);
  EXPECT_THROW(thin_track(track, std::vector{0, 1, 2, 3}, poses), InputError);
}

}  // namespace
}  // namespace hmt::submap
