// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Recordings of ROS, real ones and by ROS's own writer, as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "real_data.hpp"
#include "recordings/simulated_messages.hpp"
#include "run_command.hpp"

namespace hmt::test {
namespace {

using testing::HasSubstr;

int64_t messages_on(const nlohmann::json& info, const std::string& topic) {
  for (const auto& entry : info.at("topics"))
    if (entry.at("name") == topic) return entry.at("messages").get<int64_t>();
  return -1;
}

std::string bag(const std::string& name) {
  return data_dir() / "bags" / name;
}

// The numbers are those that rosbag, ros2 bag and sqlite3 tell.
TEST(RealRecordings, InfoTellsWhatIsInThem) {
  HMT_REQUIRE_REAL_DATA("bags");
  const struct {
    const char* file;
    const char* topic;
    int64_t messages;
  } known[] = {{"scan_tools_demo.bag", "/scan", 360},     {"tilt_laser.bag", "/scan", 178},
               {"tilt_laser.bag", "/temperature", 712},   {"foxglove_example-lz4.bag", "/tf", 2688},
               {"foxglove_example-bz2.bag", "/tf", 2688}, {"rosbag2_test_0.db3", "/imu", 1565},
               {"rosbag2_test_0.db3", "/rosout", 0},      {"rosbag2_talker.mcap", "/topic", 10},
               {"nav2_turtlebot.mcap", "/odom", 2639},    {"nav2_turtlebot.mcap", "/tf", 5422}};
  for (const auto& [file, topic, messages] : known) {
    const CommandResult info = run_hmtmap("info --json " + bag(file));
    EXPECT_EQ(info.code, 0) << file << ": " << info.err;
    EXPECT_EQ(messages_on(info.json(), topic), messages) << file;
    EXPECT_TRUE(info.json().contains("no_map_because")) << file;
  }
}

TEST(RealRecordings, ABagOfAnOldFormatIsRefusedWithTheReason) {
  HMT_REQUIRE_REAL_DATA("bags/scan_tools_sparsifier_demo.bag");
  const CommandResult info = run_hmtmap("info " + bag("scan_tools_sparsifier_demo.bag"));
  EXPECT_EQ(info.code, 1);
  EXPECT_THAT(info.err, HasSubstr("#ROSRECORD V1.2"));
}

TEST(RealRecordings, WithoutOdometryTheyCannotBeMappedAndItSaysSo) {
  HMT_REQUIRE_REAL_DATA("bags/scan_tools_demo.bag");
  const TemporaryFolder folder;
  const CommandResult map =
      run_hmtmap("map " + bag("scan_tools_demo.bag") + " -o " + (folder.path() / "a.hmt").string());
  EXPECT_EQ(map.code, 1);
  EXPECT_THAT(map.err, HasSubstr("no odometry"));
  EXPECT_EQ(run_hmtmap("check " + bag("scan_tools_demo.bag")).code, 1);
}

TEST(RealRecordings, AreMappedByTheirScansWhereThatIsWanted) {
  HMT_REQUIRE_REAL_DATA("bags/scan_tools_demo.bag");
  const TemporaryFolder folder;
  const CommandResult map =
      run_hmtmap("map --json --odom-topic none " + bag("scan_tools_demo.bag") + " -o " +
                 (folder.path() / "a.hmt").string());
  ASSERT_EQ(map.code, 0) << map.err;
  EXPECT_EQ(map.json().at("observations"), 360);
}

// A topic may stand before the log, and does not swallow it.
TEST(Recordings, TopicsAreGivenOneByOne) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "a.bag";
  write_file(path, ros1_bag(simulated_messages({"rooms", 1, 1}, submap::Wire::ros1, 10)));
  EXPECT_EQ(run_hmtmap("info --scan-topic /scan " + path).code, 0);
  const CommandResult two = run_hmtmap("info --json --scan-topic /scan --scan-topic /no " + path);
  EXPECT_THAT(two.out, HasSubstr("no scan topic /no"));
}

// A damaged bag is mapped from what is left of it, and the exit code says so.
TEST(Recordings, ACutBagIsCheckedWithLosses) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "cut.bag";
  const std::string whole =
      ros1_bag(simulated_messages({"rooms", 1, 1}, submap::Wire::ros1, 50), {"none", 10});
  write_file(path, whole.substr(0, whole.size() * 2 / 3));
  const CommandResult check = run_hmtmap("check --json " + path);
  EXPECT_EQ(check.code, 3);
  const auto log = check.json().at("logs").at(0);
  EXPECT_GT(log.at("observations").get<int>(), 20);
  EXPECT_LT(log.at("observations").get<int>(), 50);
  EXPECT_FALSE(log.at("losses").empty());
}

// Bags by ROS's own library, with its index, connections in every chunk and all compressions.
TEST(Recordings, BagsOfRosbagAreReadLikeTheLogTheyWereMadeOf) {
  const TemporaryFolder folder;
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  ASSERT_EQ(run_hmtmap("simulate rooms -o " + path("log")).code, 0);
  const auto log = run_hmtmap("info --json " + path("log")).json();
  for (const char* codec : {"none", "bz2", "lz4"}) {
    const std::string command =
        "/usr/bin/python3 " HMTMAP_SOURCE_DIR "/tests/recordings/write_rosbag.py " + path("log") +
        " " + path("a.bag") + " " + codec + " >/dev/null 2>&1";
    const int status = std::system(command.c_str());
    if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "needs python3-rosbag and its messages";
    ASSERT_EQ(status, 0);
    const CommandResult info = run_hmtmap("info --json " + path("a.bag"));
    ASSERT_EQ(info.code, 0) << info.err;
    EXPECT_EQ(info.json().at("observations"), log.at("observations"));
    EXPECT_NEAR(info.json().at("path_m"), log.at("path_m"), 1e-4);
    EXPECT_EQ(info.json().at("sensors").at(0).at("points"), log.at("sensors").at(0).at("points"));
    EXPECT_EQ(info.json().at("sensors").at(0).at("misses"), log.at("sensors").at(0).at("misses"));
    EXPECT_NEAR(info.json().at("sensors").at(0).at("mount").at("x_m"), 0.1, 1e-4);
  }
}

}  // namespace
}  // namespace hmt::test
