// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/carmen_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "hmt/graph/input_error.hpp"
#include "hmt/submap/log/simulation.hpp"
#include "read_log.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

void write(const std::filesystem::path& path) {
  CarmenWriter writer(path);
  Simulation simulation({"rooms", 1, 1});
  while (const auto scan = simulation.next()) {
    const Observation& observation = scan->observation;
    writer.add(scan->ranges_m,
               observation.T_odom_robot * observation.readings.front().T_robot_sensor,
               observation.T_odom_robot, observation.stamp_s);
  }
  writer.commit();
}

std::string head(const std::filesystem::path& path) {
  std::string bytes(2, '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), 2);
  return bytes;
}

class CarmenFile : public testing::TestWithParam<std::pair<std::string, std::string>> {};

TEST_P(CarmenFile, IsReadBackAsItWasSimulated) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / ("a.log" + GetParam().first);
  write(path);
  EXPECT_EQ(head(path), GetParam().second);
  const auto read = test::read_log(path);
  const auto simulated = simulate({"rooms", 1, 1}).observations;
  ASSERT_EQ(read.size(), simulated.size());
  for (size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].stamp_s, simulated[i].stamp_s);
    EXPECT_LT(boxminus(read[i].T_odom_robot, simulated[i].T_odom_robot).norm(), 2e-6);
    ASSERT_EQ(read[i].readings.size(), 1u);
    const Reading& reading = read[i].readings[0];
    EXPECT_EQ(reading.points_sensor, simulated[i].readings[0].points_sensor);
    EXPECT_EQ(reading.misses_sensor, simulated[i].readings[0].misses_sensor);
    EXPECT_LT(boxminus(reading.T_robot_sensor, Pose::planar(0.1, 0, 0)).norm(), 3e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, CarmenFile,
                         testing::Values(std::pair(std::string(), std::string("# ")),
                                         std::pair(std::string(".gz"), std::string("\x1f\x8b")),
                                         std::pair(std::string(".bz2"), std::string("BZ")),
                                         std::pair(std::string(".zst"), std::string("\x28\xb5"))));

TEST(CarmenWriter, LeavesNothingWithoutCommit) {
  const test::TemporaryFolder folder;
  { CarmenWriter writer(folder.path() / "a.log.gz"); }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(CarmenWriter, SaysThatTheDiskIsFull) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "a.log.gz") << "before";
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  getrlimit(RLIMIT_FSIZE, &old_limit);
  rlimit limit = old_limit;
  limit.rlim_cur = 20000;
  setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_THROW(write(folder.path() / "a.log.gz"), graph::InputError);
  setrlimit(RLIMIT_FSIZE, &old_limit);
  EXPECT_EQ(head(folder.path() / "a.log.gz"), "be");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.log.gz.tmp"));
}

}  // namespace
}  // namespace hmt::submap
