// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/evaluation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "hmt/graph/input_error.hpp"
#include "read_log.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using graph::Pose;
using std::numbers::pi;

std::vector<StampedPose> square() {
  return {{1, Pose::planar(0, 0, 0)},
          {2, Pose::planar(2, 0, pi / 2)},
          {3, Pose::planar(2, 2, pi)},
          {4, Pose::planar(0, 2, -pi / 2)}};
}

std::vector<StampedPose> moved(std::vector<StampedPose> trajectory, const Pose& T) {
  for (StampedPose& pose : trajectory) pose.T_world_robot = T * pose.T_world_robot;
  return trajectory;
}

TEST(RelationsError, IsMeanOfLengthsAndAngles) {
  // From 1 to 2 the square goes 2 m ahead and turns left; the relations differ from that by
  // (0.3, 0.4) m and 0 rad, and by 0 m and 0.1 rad.
  const std::vector<Relation> relations = {{1, 2, Pose::planar(2.3, 0.4, pi / 2)},
                                           {1, 2, Pose::planar(2, 0, pi / 2 - 0.1)}};
  const RelationsError error = evaluate_relations(square(), relations);
  EXPECT_EQ(error.relations_used, 2);
  EXPECT_NEAR(error.trans_mean_m, 0.25, 1e-12);
  EXPECT_NEAR(error.trans_std_m, 0.25, 1e-12);
  EXPECT_NEAR(error.rot_mean_rad, 0.05, 1e-12);
  EXPECT_NEAR(error.rot_std_rad, 0.05, 1e-12);
}

TEST(RelationsError, DoesNotChangeWithTheWorldFrame) {
  const std::vector<Relation> relations = {{1, 3, Pose::planar(2.1, 2, 3)},
                                           {2, 4, Pose::planar(2, 2.2, -3)}};
  const auto here = evaluate_relations(square(), relations);
  const auto there = evaluate_relations(moved(square(), Pose::planar(-7, 9, 2)), relations);
  EXPECT_NEAR(here.trans_mean_m, there.trans_mean_m, 1e-12);
  EXPECT_NEAR(here.rot_mean_rad, there.rot_mean_rad, 1e-12);
}

TEST(RelationsError, CountsRelationsWithoutTheirStamps) {
  const std::vector<Relation> relations = {{1.004, 2.004, Pose::planar(2, 0, pi / 2)},
                                           {1, 2.5, Pose{}}};
  const RelationsError error = evaluate_relations(square(), relations);
  EXPECT_EQ(error.relations, 2);
  EXPECT_EQ(error.relations_used, 1);
  EXPECT_NEAR(error.trans_mean_m, 0, 1e-12);
  EXPECT_THROW(evaluate_relations(square(), std::vector<Relation>{{8, 9, Pose{}}}),
               graph::InputError);
}

TEST(RelationsFile, ReadsRollPitchYaw) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "r") << "1 2 3 4 5 0.1 0.2 0.3\n";
  const auto relations = read_relations(folder.path() / "r");
  ASSERT_EQ(relations.size(), 1u);
  EXPECT_EQ(relations[0].T_from_to.translation, Eigen::Vector3d(3, 4, 5));
  const Eigen::Matrix3d R = relations[0].T_from_to.rotation_matrix();
  EXPECT_NEAR(std::atan2(R(2, 1), R(2, 2)), 0.1, 1e-12);
  EXPECT_NEAR(-std::asin(R(2, 0)), 0.2, 1e-12);
  EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), 0.3, 1e-12);
}

TEST(RelationsFile, NamesFileAndLineOfWhatItRefuses) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "r") << "1 2 3 4 5 0.1 0.2 0.3\n1 2 3\n";
  try {
    read_relations(folder.path() / "r");
    FAIL() << "not refused";
  } catch (const graph::InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("r:2: line ends before translation"));
  }
}

TEST(TrajectoryError, IsZeroForTheSameShapeElsewhere) {
  const auto planar = evaluate_trajectory(moved(square(), Pose::planar(5, -3, 2.5)), square());
  EXPECT_EQ(planar.matched, 4);
  EXPECT_NEAR(planar.ate_rmse_m, 0, 1e-12);
  EXPECT_NEAR(planar.rpe_trans_rmse_m, 0, 1e-12);
  const Pose tilt{{1, 2, 3},
                  Eigen::Quaterniond(Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()))};
  const auto spatial = evaluate_trajectory(moved(square(), tilt), square());
  EXPECT_NEAR(spatial.ate_rmse_m, 0, 1e-12);
  EXPECT_NEAR(spatial.rpe_rot_rmse_rad, 0, 1e-7);
}

TEST(TrajectoryError, AlignsTwoPosesAtTheirMiddle) {
  // 4 m apart against 2 m apart: after alignment both ends are 1 m off.
  const std::vector<StampedPose> reference = {{1, Pose::planar(0, 0, 0)},
                                              {2, Pose::planar(2, 0, 0)}};
  const std::vector<StampedPose> longer = {{1, Pose::planar(0, 0, 0)}, {2, Pose::planar(4, 0, 0)}};
  const auto error = evaluate_trajectory(longer, reference);
  EXPECT_NEAR(error.ate_rmse_m, 1, 1e-12);
  EXPECT_NEAR(error.ate_max_m, 1, 1e-12);
  EXPECT_EQ(error.rpe_pairs, 1);
  EXPECT_NEAR(error.rpe_trans_rmse_m, 2, 1e-12);
}

TEST(TrajectoryError, DoesNotFitAMirrorImageInThePlane) {
  auto mirrored = square();
  for (StampedPose& pose : mirrored) pose.T_world_robot.translation.y() *= -1;
  // A mirrored square is the square gone round the other way: best with two corners right.
  EXPECT_NEAR(evaluate_trajectory(mirrored, square()).ate_rmse_m, 2, 1e-9);
}

TEST(TrajectoryError, NeedsTwoMatches) {
  EXPECT_THROW(evaluate_trajectory(square(), std::vector<StampedPose>{{1, Pose{}}, {9, Pose{}}}),
               graph::InputError);
}

struct Odometry {
  const char* log;
  double error_m;  ///< by the README of the data
};

struct Relations {
  const char* log;
  int64_t count;
};

std::vector<StampedPose> odometry(const std::string& base) {
  std::vector<StampedPose> poses;
  for (const Observation& observation : test::read_log(test::data_dir() / (base + ".clf.bz2")))
    poses.push_back({observation.stamp_s, observation.T_odom_robot});
  return poses;
}

class RawOdometry : public testing::TestWithParam<Odometry> {};

TEST_P(RawOdometry, IsAsWrongAsKnown) {
  const std::string base = std::string("laser2d/") + GetParam().log;
  HMT_REQUIRE_REAL_DATA(base + ".clf.bz2");
  const auto reference = read_tum(test::data_dir() / (base + ".keyframes.tum"));
  const TrajectoryError error = evaluate_trajectory(odometry(base), reference);
  EXPECT_EQ(error.matched, static_cast<int64_t>(reference.size()));
  EXPECT_NEAR(error.ate_rmse_m / GetParam().error_m, 1, 0.02);
}

class RawOdometryRelations : public testing::TestWithParam<Relations> {};

TEST_P(RawOdometryRelations, HaveAPoseForEveryRelation) {
  const std::string base = std::string("laser2d/") + GetParam().log;
  HMT_REQUIRE_REAL_DATA(base + ".clf.bz2");
  const auto relations = read_relations(test::data_dir() / (base + ".relations"));
  const RelationsError error = evaluate_relations(odometry(base), relations);
  EXPECT_EQ(error.relations_used, GetParam().count);
  EXPECT_GT(error.trans_mean_m, 5);
}

INSTANTIATE_TEST_SUITE_P(Logs, RawOdometry,
                         testing::Values(Odometry{"intel", 24}, Odometry{"fr079", 14.1},
                                         Odometry{"mit-csail", 8.7}, Odometry{"fr101", 8.6},
                                         Odometry{"seattle", 2.7}));
INSTANTIATE_TEST_SUITE_P(Logs, RawOdometryRelations,
                         testing::Values(Relations{"intel", 2984}, Relations{"fr079", 1685}));

TEST(RelationsError, OfTheReferenceOfFr079IsAsPublished) {
  HMT_REQUIRE_REAL_DATA("laser2d/fr079.relations");
  const auto reference = read_tum(test::data_dir() / "laser2d/fr079.keyframes.tum");
  const auto relations = read_relations(test::data_dir() / "laser2d/fr079.relations");
  const RelationsError error = evaluate_relations(reference, relations);
  EXPECT_NEAR(error.trans_mean_m, 0.058, 0.0005);
  EXPECT_NEAR(error.rot_mean_rad * 180 / pi, 0.70, 0.005);
}

}  // namespace
}  // namespace hmt::submap
