// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// The same drive, recorded in each format, gives the same map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hmt/submap/export/carmen_file.hpp"
#include "hmt/submap/export/evaluation.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/pipeline.hpp"
#include "recordings/simulated_messages.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

const SimulationOptions kDrive{"rooms", 5, 1};

HybridMap map_of(const std::filesystem::path& log, const Options& options = {}) {
  Run run;
  run.threads = 2;
  const auto result =
      build_map(log, log.string() + ".hmt", options, MapFile::Existing::resume, run);
  return result.file.load_map();
}

void write_carmen(const std::filesystem::path& path) {
  Simulation simulation(kDrive);
  CarmenWriter writer(path);
  while (const auto scan = simulation.next()) {
    const Observation& observation = scan->observation;
    writer.add(scan->ranges_m,
               observation.T_odom_robot * observation.readings.front().T_robot_sensor,
               observation.T_odom_robot, observation.stamp_s);
  }
  writer.commit();
}

void expect_same_division(const HybridMap& a, const HybridMap& b) {
  ASSERT_EQ(a.submaps.size(), b.submaps.size());
  for (size_t k = 0; k < a.submaps.size(); ++k)
    EXPECT_EQ(a.submaps[k].keyframes, b.submaps[k].keyframes);
}

TEST(Formats, GiveTheSameMap) {
  const test::TemporaryFolder folder;
  const auto ros1 = test::simulated_messages(kDrive, Wire::ros1);
  const auto ros2 = test::simulated_messages(kDrive, Wire::cdr);
  write_carmen(folder.path() / "log.carmen");
  test::write_file(folder.path() / "log.bag", test::ros1_bag(ros1, {"lz4", 100}));
  test::write_file(folder.path() / "log.mcap", test::mcap_file(ros2, {"zstd", 100}));
  test::write_sqlite_bag(folder.path() / "log.db3", ros2);

  const HybridMap bag = map_of(folder.path() / "log.bag");
  const auto expected = stamped_trajectory(bag);
  EXPECT_GT(bag.submaps.size(), 1u);
  // Recordings hold the same numbers, so the maps are equal to the last bit.
  for (const char* name : {"log.mcap", "log.db3"}) {
    const HybridMap other = map_of(folder.path() / name);
    expect_same_division(bag, other);
    const auto trajectory = stamped_trajectory(other);
    ASSERT_EQ(trajectory.size(), expected.size());
    for (size_t k = 0; k < expected.size(); ++k)
      EXPECT_EQ(trajectory[k].T_world_robot, expected[k].T_world_robot) << name << " pose " << k;
  }
  // CARMEN's text rounds poses to micrometres, and a bag's angles and ranges are floats; where a
  // registration ends shows it by some millimetres.
  const HybridMap carmen = map_of(folder.path() / "log.carmen");
  expect_same_division(bag, carmen);
  const auto trajectory = stamped_trajectory(carmen);
  ASSERT_EQ(trajectory.size(), expected.size());
  for (size_t k = 0; k < expected.size(); ++k) {
    EXPECT_NEAR(trajectory[k].stamp_s, expected[k].stamp_s, 1e-6);
    EXPECT_LT(boxminus(trajectory[k].T_world_robot, expected[k].T_world_robot).norm(), 0.01)
        << "pose " << k;
  }
}

/// The same drive with two lasers on the robot's corners, each of which has half of the beams; the
/// right one hangs upside down.
std::vector<test::SampleMessage> two_lasers() {
  constexpr float kDegree = std::numbers::pi_v<float> / 180;
  std::vector<test::SampleMessage> messages;
  Simulation simulation(kDrive);
  while (const auto scan = simulation.next()) {
    const auto stamp_ns = static_cast<int64_t>(std::llround(scan->observation.stamp_s * 1e9));
    const Pose& T_robot_sensor = scan->observation.readings.front().T_robot_sensor;
    const Eigen::Quaterniond upside_down(0, 1, 0, 0);
    const Pose left = T_robot_sensor * Pose::planar(0, 0, std::numbers::pi / 4);
    const Pose right = T_robot_sensor * Pose::planar(0, 0, -std::numbers::pi / 4) *
                       Pose{Eigen::Vector3d::Zero(), upside_down};
    if (messages.empty())
      messages.push_back({"/tf_static", "tf2_msgs/TFMessage", stamp_ns,
                          test::transforms(test::WireWriter(Wire::cdr),
                                           {{stamp_ns, "base_link", "left", left},
                                            {stamp_ns, "base_link", "right", right}})});
    messages.push_back(
        {"/odom", "nav_msgs/Odometry", stamp_ns,
         test::odometry(test::WireWriter(Wire::cdr), stamp_ns, scan->observation.T_odom_robot)});
    test::SampleScan sample{stamp_ns, "left", -45 * kDegree, kDegree, 0, 80, {}};
    sample.ranges.assign(scan->ranges_m.begin() + 90, scan->ranges_m.end());
    messages.push_back({"/left", "sensor_msgs/LaserScan", stamp_ns,
                        test::laser_scan(test::WireWriter(Wire::cdr), sample)});
    sample.frame = "right";
    sample.ranges.assign(scan->ranges_m.rend() - 91, scan->ranges_m.rend());
    messages.push_back({"/right", "sensor_msgs/LaserScan", stamp_ns,
                        test::laser_scan(test::WireWriter(Wire::cdr), sample)});
  }
  return messages;
}

TEST(SeveralSensors, TwoLasersMapAsWellAsOneWithTheirBeams) {
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "log.mcap", test::mcap_file(two_lasers(), {"zstd", 100}));
  Options options;
  options.log.scan_topics = {"/left", "/right"};
  const HybridMap map = map_of(folder.path() / "log.mcap", options);
  EXPECT_GT(map.submaps.size(), 1u);
  std::vector<StampedPose> truth;
  Simulation simulation(kDrive);
  while (const auto scan = simulation.next())
    truth.push_back({scan->observation.stamp_s, scan->T_world_robot});
  const TrajectoryError error = evaluate_trajectory(stamped_trajectory(map), truth);
  EXPECT_EQ(map.track.observations.size(), truth.size());
  EXPECT_LT(error.ate_rmse_m, 0.03);
}

}  // namespace
}  // namespace hmt::submap
