// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>

#include "hmt/submap/export/landmarks_file.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/pipeline.hpp"
#include "real_data.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

/// A robot that drives two rounds on a circle of 20 m, between trees on both sides of its way.
struct Park {
  std::map<int64_t, Eigen::Vector2d> trees;
  std::vector<Pose> T_world_robot;

  explicit Park(const std::filesystem::path& log) {
    std::mt19937 generator(1);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 40; ++k) {
      const double angle = 2 * std::numbers::pi * k / 40;
      const double radius = k % 2 == 0 ? 24 : 16.5;
      trees[100 + k] = {radius * std::cos(angle), radius * std::sin(angle)};
    }
    std::ofstream out(log);
    out.precision(17);
    for (int step = 0; step < 500; ++step) {
      const double angle = 4 * std::numbers::pi * step / 500;
      T_world_robot.push_back(
          Pose::planar(20 * std::cos(angle), 20 * std::sin(angle), angle + std::numbers::pi / 2));
      if (step > 0) {
        const Pose T =
            graph::relative_pose(T_world_robot[T_world_robot.size() - 2], T_world_robot.back());
        out << "ODOMETRY " << step - 1 << " " << step << " "
            << T.translation.x() + 0.02 * normal(generator) << " "
            << T.translation.y() + 0.02 * normal(generator) << " "
            << T.yaw_rad() + 0.01 * normal(generator) << " 0.0004 0 0 0.0004 0 0.0001\n";
      }
      for (const auto& [name, p] : trees) {
        const Eigen::Vector3d seen =
            T_world_robot.back().inverse() * Eigen::Vector3d(p.x(), p.y(), 0);
        if (step > 0 && seen.norm() < 9 && seen.x() > 0)
          out << "LANDMARK " << step << " " << name << " " << seen.x() + 0.1 * normal(generator)
              << " " << seen.y() + 0.1 * normal(generator) << " 0.01 0 0.01\n";
      }
    }
  }
};

TEST(LandmarkMap, OfASimulatedParkIsTrue) {
  const test::TemporaryFolder folder;
  const Park park(folder.path() / "park.txt");
  submap::Run run;
  run.threads = 2;
  const BuildResult result = build_map(folder.path() / "park.txt", folder.path() / "park.hmt", {},
                                       MapFile::Existing::resume, run);
  const HybridMap map = result.file.load_map();
  EXPECT_EQ(map.landmarks.size(), park.trees.size());
  EXPECT_GT(map.submaps.size(), 2u);
  EXPECT_GE(map.links.size(), map.submaps.size());  // the way is a circle
  EXPECT_LT(evaluate_landmarks(map, park.trees).rmse_m, 0.08);
  const std::vector<Pose> trajectory = world_trajectory(map);
  ASSERT_EQ(trajectory.size(), park.T_world_robot.size());
  const Pose T_true_world = park.T_world_robot.front() * trajectory.front().inverse();
  for (size_t k = 0; k < trajectory.size(); ++k)
    EXPECT_LT(
        ((T_true_world * trajectory[k]).translation - park.T_world_robot[k].translation).norm(),
        0.4);
  EXPECT_GT(map.landmark_information_loss, 0);
  EXPECT_LT(map.landmark_information_loss, 0.5);
  // A landmark of a submap lies in the world where the submap says.
  for (const Submap& submap : map.submaps)
    for (const PlacedLandmark& l : submap.landmarks) {
      const Eigen::Vector3d p_world =
          map.T_world_submap[static_cast<size_t>(submap.id)] * l.position;
      EXPECT_LT((p_world - map.landmarks[static_cast<size_t>(l.landmark)].position).norm(), 0.5);
    }
}

TEST(LandmarkMap, IsTheSameOnOneAndOnTwoThreads) {
  const test::TemporaryFolder folder;
  const Park park(folder.path() / "park.txt");
  std::vector<std::string> csv;
  for (const int threads : {1, 2}) {
    submap::Run run;
    run.threads = threads;
    const auto path = folder.path() / ("park" + std::to_string(threads) + ".hmt");
    const HybridMap map =
        build_map(folder.path() / "park.txt", path, {}, MapFile::Existing::resume, run)
            .file.load_map();
    csv.push_back(landmarks_csv(map));
  }
  EXPECT_EQ(csv[0], csv[1]);
}

TEST(LandmarkMap, OfVictoriaParkHasAllItsTrees) {
  HMT_REQUIRE_REAL_DATA("landmarks/victoria_park.txt");
  const test::TemporaryFolder folder;
  submap::Run run;
  run.threads = 2;
  const HybridMap map = build_map(test::data_dir() / "landmarks/victoria_park.txt",
                                  folder.path() / "park.hmt", {}, MapFile::Existing::resume, run)
                            .file.load_map();
  EXPECT_EQ(map.landmarks.size(), 151u);
  EXPECT_EQ(map.track.observations.size(), 6969u);
  EXPECT_GT(map.sightings.size(), 3560u);  // of 3640: a few contradict the rest
}

}  // namespace
}  // namespace hmt::submap
