// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <vector>

#include "hmt/submap/export/carmen_file.hpp"
#include "hmt/submap/export/evaluation.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/log/simulation.hpp"
#include "hmt/submap/pipeline.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

/// A simulated log on disk with its truth.
struct LogOnDisk {
  fs::path path;
  std::vector<StampedPose> truth;
};

LogOnDisk write_log(const fs::path& folder, const std::string& world) {
  LogOnDisk log{folder / (world + ".log"), {}};
  Simulation simulation({.world = world});
  CarmenWriter writer(log.path);
  while (const auto scan = simulation.next()) {
    const Observation& o = scan->observation;
    writer.add(scan->ranges_m, o.T_odom_robot * o.readings.at(0).T_robot_sensor, o.T_odom_robot,
               o.stamp_s);
    log.truth.push_back({o.stamp_s, scan->T_world_robot});
  }
  writer.commit();
  return log;
}

Run two_threads() {
  Run run;
  run.threads = 2;
  return run;
}

/// Median distance between the true positions of a submap's keyframes and their mean.
double spread_m(const Submap& submap, const Track& track, const std::vector<StampedPose>& truth) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> at;
  for (const int k : submap.keyframes) {
    const auto observation =
        static_cast<size_t>(track.keyframes[static_cast<size_t>(k)].observation);
    at.push_back(truth[observation].T_world_robot.translation);
    mean += at.back() / static_cast<double>(submap.keyframes.size());
  }
  std::vector<double> distances;
  for (const Eigen::Vector3d& p : at) distances.push_back((p - mean).norm());
  std::nth_element(distances.begin(),
                   distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2),
                   distances.end());
  return distances[distances.size() / 2];
}

class SimulatedBuilding : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    log_ = new LogOnDisk(write_log(folder_->path(), "building"));
    const BuildResult result = build_map(log_->path, folder_->path() / "map.hmt", {},
                                         MapFile::Existing::resume, two_threads());
    map_ = new HybridMap(result.file.load_map());
  }
  static void TearDownTestSuite() {
    delete map_;
    delete log_;
    delete folder_;
  }

  Pose true_pose(int keyframe) const {
    const auto observation = map_->track.keyframes.at(static_cast<size_t>(keyframe)).observation;
    return log_->truth.at(static_cast<size_t>(observation)).T_world_robot;
  }

  inline static test::TemporaryFolder* folder_ = nullptr;
  inline static LogOnDisk* log_ = nullptr;
  inline static HybridMap* map_ = nullptr;
};

TEST_F(SimulatedBuilding, IsMappedToWithinCentimetresOfTheTruth) {
  const TrajectoryError error = evaluate_trajectory(stamped_trajectory(*map_), log_->truth);
  EXPECT_EQ(error.matched, static_cast<int64_t>(log_->truth.size()));
  EXPECT_LT(error.ate_rmse_m, 0.05);
}

TEST_F(SimulatedBuilding, AcceptsNoFalseLoop) {
  for (const LoopCandidate& loop : map_->loops) {
    if (loop.verdict != LoopVerdict::accepted) continue;
    const Vector6d error =
        graph::boxminus(loop.T_a_b, graph::relative_pose(true_pose(loop.a), true_pose(loop.b)));
    EXPECT_LT(error.head<3>().norm(), 0.3) << loop.a << " -> " << loop.b;
    EXPECT_LT(error.tail<3>().norm(), 0.1) << loop.a << " -> " << loop.b;
  }
}

TEST_F(SimulatedBuilding, EveryKeyframeIsInExactlyOneSubmap) {
  std::vector<int> count(map_->track.keyframes.size(), 0);
  for (const Submap& submap : map_->submaps)
    for (const int k : submap.keyframes) ++count.at(static_cast<size_t>(k));
  EXPECT_EQ(std::set<int>(count.begin(), count.end()), std::set<int>{1});
}

TEST_F(SimulatedBuilding, IsCutIntoCompactSubmaps) {
  // Rooms are some metres wide; what sees little of each other is apart.
  EXPECT_GT(map_->submaps.size(), 3u);
  for (const Submap& submap : map_->submaps)
    EXPECT_LT(spread_m(submap, map_->track, log_->truth), 8.0) << "submap " << submap.id;
}

TEST_F(SimulatedBuilding, APlaceThatIsVisitedTwiceIsOneSubmap) {
  // Keyframes at one place with one heading see the same, however much later: same submap for most.
  int same = 0;
  int pairs = 0;
  const int n = static_cast<int>(map_->track.keyframes.size());
  for (int a = 0; a < n; ++a)
    for (int b = a + 30; b < n; ++b) {
      const Vector6d apart = graph::boxminus(true_pose(b), true_pose(a));
      if (apart.head<3>().norm() > 0.5 || apart.tail<3>().norm() > 0.3) continue;
      ++pairs;
      same += map_->submap_of_keyframe[static_cast<size_t>(a)] ==
                      map_->submap_of_keyframe[static_cast<size_t>(b)]
                  ? 1
                  : 0;
    }
  ASSERT_GT(pairs, 10);
  EXPECT_GT(same, 0.9 * pairs);
}

TEST_F(SimulatedBuilding, LinksConnectAllSubmapsAndOweTheirShareOfTheInformation) {
  std::vector<bool> reached(map_->submaps.size(), false);
  reached[0] = true;
  double loss = 0;
  for (size_t pass = 0; pass < map_->submaps.size(); ++pass)
    for (const Link& link : map_->links)
      if (reached.at(static_cast<size_t>(link.a)) || reached.at(static_cast<size_t>(link.b)))
        reached[static_cast<size_t>(link.a)] = reached[static_cast<size_t>(link.b)] = true;
  EXPECT_TRUE(std::all_of(reached.begin(), reached.end(), [](bool r) { return r; }));
  for (const Link& link : map_->links) loss += link.information_loss;
  EXPECT_LE(loss, map_->information_loss + 1e-12);
  EXPECT_GT(map_->information_loss, 0);
  EXPECT_LT(map_->information_loss, 0.2);
}

TEST(BuildMap, ThreeRoomsInARowAreApart) {
  const test::TemporaryFolder folder;
  const LogOnDisk log = write_log(folder.path(), "rooms");
  const BuildResult result =
      build_map(log.path, folder.path() / "map.hmt", {}, MapFile::Existing::resume, {});
  const HybridMap map = result.file.load_map();
  EXPECT_GE(map.submaps.size(), 2u);
  EXPECT_LE(map.submaps.size(), 6u);
}

}  // namespace
}  // namespace hmt::submap
