// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "hmt/submap/export/landmarks_file.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/pipeline.hpp"
#include "park.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using test::Park;

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

TEST(LandmarkMap, NeedsNoNamesWhereTreesStandApart) {
  const test::TemporaryFolder folder;
  const Park park(folder.path() / "park.txt", false);
  const HybridMap map = build_map(folder.path() / "park.txt", folder.path() / "park.hmt", {},
                                  MapFile::Existing::resume, {})
                            .file.load_map();
  // Each tree is one landmark, in both rounds.
  EXPECT_EQ(map.landmarks.size(), park.trees.size());
  const Pose T_true_world = park.T_world_robot.front() * world_trajectory(map).front().inverse();
  for (const PlacedLandmark& landmark : map.landmarks) {
    EXPECT_EQ(map.landmark_names[static_cast<size_t>(landmark.landmark)], kUnknownLandmark);
    double nearest_m = 1e9;
    for (const auto& [name, p] : park.trees)
      nearest_m = std::min(nearest_m, ((T_true_world * landmark.position).head<2>() - p).norm());
    EXPECT_LT(nearest_m, 0.5);
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

}  // namespace
}  // namespace hmt::submap
