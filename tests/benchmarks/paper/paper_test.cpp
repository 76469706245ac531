// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Keeps the experiments alive: their parts by hand-computed cases, and each experiment small.

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "ekf_slam.hpp"
#include "figures.hpp"
#include "robot_model.hpp"
#include "straight_path_study.hpp"
#include "temporary_folder.hpp"

namespace hmt::paper {
namespace {

using testing::EndsWith;
using testing::StartsWith;

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

void expect_all(const std::vector<Claim>& claims) {
  for (const Claim& claim : claims) EXPECT_TRUE(claim.holds) << claim.text;
}

TEST(EkfSlam, KnowsALandmarkAsWellAsTheMeanOfItsMeasurements) {
  // From the known start: a landmark at 2 m ahead, sigma 0.1 m along and 2 m * 0.05 rad across.
  EkfSlam filter(0.1, 0.05);
  const std::vector<RangeBearing> ahead = {{7, 2, 0}};
  for (int i = 0; i < 4; ++i) filter.update(ahead);
  EXPECT_THAT(filter.landmarks(), testing::ElementsAre(7));
  const Eigen::Matrix2d covariance = filter.covariance().bottomRightCorner<2, 2>();
  EXPECT_TRUE(covariance.isApprox(Eigen::Matrix2d::Identity() * 0.01 / 4, 1e-9)) << covariance;
}

TEST(EkfSlam, TurnsMotionIntoTheWorldFrame) {
  EkfSlam filter(0.1, 0.1);
  filter.predict({0, 0, std::numbers::pi / 2}, Eigen::Matrix3d::Zero());
  filter.predict({1, 0, 0}, Eigen::Vector3d(0.04, 0.09, 0).asDiagonal());
  EXPECT_TRUE(filter.pose().isApprox(Eigen::Vector3d(0, 1, std::numbers::pi / 2), 1e-12));
  // Along the robot's x is along the world's y.
  EXPECT_NEAR(filter.covariance()(0, 0), 0.09, 1e-12);
  EXPECT_NEAR(filter.covariance()(1, 1), 0.04, 1e-12);
}

TEST(LandmarkInformationLoss, CountsPairsWithoutACommonSubmap) {
  // Landmark 0 is seen by observation 0, 1 by both, 2 by observation 1: cut between the two, only 0
  // and 2 share no submap. |H| = [5 1 2; 1 5 1; 2 1 5]: 4 of 23.
  StraightPathRun run;
  run.seen = {{0, 1}, {1, 2}};
  run.state_landmarks = {0, 1, 2};
  run.information.resize(3, 3);
  run.information << 5, 1, 2, 1, 5, 1, 2, 1, 5;
  EXPECT_DOUBLE_EQ(landmark_information_loss(run, {0, 1}), 4.0 / 23);
  EXPECT_EQ(landmark_information_loss(run, {0, 0}), 0);
}

TEST(StraightPath, ShowsWhatThePaperReports) {
  const StraightPathStudy study = study_straight_path({}, 6, {}, 2);
  EXPECT_GE(study.lower_means(), 40);
  EXPECT_LT(study.ncut.high, 1);
  EXPECT_LT(study.by_tau.front().mean, 0.1);
}

TEST(StraightPath, LosesLittleWhereTheOdometrySaysLittle) {
  // Only the odometry ties landmarks that were never seen together.
  StraightPathParameters poor;
  poor.sigma_odometry_m *= 10;
  poor.sigma_odometry_rad *= 10;
  const auto loss = [](const StraightPathParameters& p) {
    const StraightPathRun run = run_straight_path(p, 1);
    graph::Labels pairs(run.seen.size());
    for (size_t k = 0; k < pairs.size(); ++k) pairs[k] = static_cast<int>(k / 2);
    return landmark_information_loss(run, pairs);
  };
  EXPECT_LT(loss(poor), 0.2 * loss({}));
}

TEST(PaperFigures, ThreeRoomsAreThreeGroups) {
  const test::TemporaryFolder folder;
  expect_all(draw_three_rooms(folder.path()));
  const std::string svg = text_of(folder.path() / "fig5.svg");
  EXPECT_THAT(svg, StartsWith("<svg "));
  EXPECT_THAT(svg, EndsWith("</svg>\n"));
}

TEST(PaperFigures, AreasFallWithTheFieldOfView) {
  const test::TemporaryFolder folder;
  expect_all(draw_sensors(folder.path(), {"building"}, 2));
  EXPECT_THAT(text_of(folder.path() / "fig9_building.csv"),
              StartsWith("sensors,keyframes,areas_at_tau_"));
}

}  // namespace
}  // namespace hmt::paper
