// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// The same drive, recorded in each format, gives the same map.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hmt/submap/export/carmen_file.hpp"
#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/pipeline.hpp"
#include "recordings/simulated_messages.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

const SimulationOptions kDrive{"rooms", 5, 1};

HybridMap map_of(const std::filesystem::path& log) {
  Run run;
  run.threads = 2;
  const auto result =
      build_map(log, log.string() + ".hmt", Options{}, MapFile::Existing::resume, run);
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

}  // namespace
}  // namespace hmt::submap
