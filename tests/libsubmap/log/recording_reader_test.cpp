// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// From messages to observations: topics, frames, odometry and clocks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "hmt/submap/log/log_check.hpp"
#include "hmt/submap/log/recording_summary.hpp"
#include "log/ros/transform_tree.hpp"
#include "recordings/simulated_messages.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using test::SampleMessage;
using test::WireWriter;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int64_t kSecond = 1'000'000'000;
constexpr int64_t kStart = 1'600'000'000 * kSecond;
constexpr int64_t kDelay = kSecond / 100;

struct ReadLog {
  std::vector<Observation> observations;
  LogReport report;
  Space space = Space::se2;
};

/// Builds a bag message by message and reads it as a log.
class RecordedLog : public testing::Test {
 protected:
  void add(const std::string& topic, const std::string& type, int64_t received_ns,
           std::string bytes) {
    messages_.push_back({topic, type, received_ns, std::move(bytes)});
  }
  void add_scan(int64_t stamp_ns, const std::string& topic = "/scan",
                const std::string& frame = "laser") {
    const test::SampleScan scan{stamp_ns, frame, 0, 0.5, 0.2F, 30, {1, 2, 0.1, 31, 0}};
    add(topic, "sensor_msgs/LaserScan", stamp_ns + kDelay, laser_scan(out(), scan));
  }
  /// The robot drives along x at 1 m/s.
  void add_odometry(int64_t stamp_ns, const std::string& topic = "/odom") {
    const double x = static_cast<double>(stamp_ns - kStart) * 1e-9;
    add(topic, "nav_msgs/Odometry", stamp_ns + kDelay,
        odometry(out(), stamp_ns, Pose::planar(x, 0, 0)));
  }
  void add_transform(const std::string& topic, int64_t stamp_ns, const std::string& parent,
                     const std::string& child, const Pose& T) {
    add(topic, "tf2_msgs/TFMessage", stamp_ns + kDelay,
        transforms(out(), {{stamp_ns, parent, child, T}}));
  }
  /// Odometry at 0.0, 0.5, ... s and scans at 0.25, 0.75, ...
  void drive(int steps) {
    for (int k = 0; k < steps; ++k) {
      add_odometry(kStart + k * kSecond / 2);
      add_scan(kStart + k * kSecond / 2 + kSecond / 4);
    }
    add_odometry(kStart + steps * kSecond / 2);
  }

  ReadLog read(const LogOptions& options = {}) {
    const auto reader = open_log(write(), options);
    ReadLog log;
    while (auto observation = reader->next()) log.observations.push_back(std::move(*observation));
    log.report = reader->report();
    log.space = reader->space();
    return log;
  }
  std::string reason(const LogOptions& options = {}) {
    try {
      read(options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::filesystem::path write() {
    test::write_file(folder_.path() / "log.bag", test::ros1_bag(messages_, {"lz4", 9}));
    return folder_.path() / "log.bag";
  }
  static WireWriter out() { return WireWriter(Wire::ros1); }

  test::TemporaryFolder folder_;
  std::vector<SampleMessage> messages_;
};

TEST_F(RecordedLog, OdometryIsInterpolatedAtTheScans) {
  drive(4);
  const ReadLog log = read();
  ASSERT_EQ(log.observations.size(), 4u);
  EXPECT_EQ(log.report.odometry_records, 5);
  EXPECT_TRUE(log.report.losses.empty());
  for (int k = 0; k < 4; ++k) {
    const Observation& o = log.observations[static_cast<size_t>(k)];
    EXPECT_EQ(o.index, k);
    EXPECT_NEAR(o.stamp_s, 1.6e9 + 0.25 + 0.5 * k, 1e-6);
    EXPECT_NEAR(o.T_odom_robot.translation.x(), 0.25 + 0.5 * k, 1e-9);
  }
}

TEST_F(RecordedLog, RangesBecomePointsAndMisses) {
  drive(1);
  const ReadLog log = read();
  const Reading& reading = log.observations.at(0).readings.at(0);
  EXPECT_EQ(reading.max_range_m, 30);
  EXPECT_EQ(reading.beam_step_rad, 0.5);
  ASSERT_EQ(reading.points_sensor.size(), 2u);
  EXPECT_TRUE(
      reading.points_sensor[1].isApprox(2 * Eigen::Vector3f(std::cos(0.5F), std::sin(0.5F), 0)));
  EXPECT_EQ(reading.misses_sensor.size(), 1u);
  EXPECT_EQ(log.report.notes.at("ranges left out: below range_min"), 1);
  EXPECT_EQ(log.report.notes.at("ranges left out: zero or negative"), 1);
}

TEST_F(RecordedLog, TheMountIsThatOfTheTransforms) {
  add_transform("/tf_static", 0, "base_link", "plate", Pose::planar(0.5, 0, 0));
  add_transform("/tf_static", 0, "plate", "laser", Pose::planar(0, 0.25, std::numbers::pi / 2));
  drive(2);
  const Pose T = read().observations.at(0).readings.at(0).T_robot_sensor;
  EXPECT_LT(boxminus(T, Pose::planar(0.5, 0.25, std::numbers::pi / 2)).norm(), 1e-12);
}

TEST_F(RecordedLog, ALaserUpsideDownIsTurnedOver) {
  const Pose hanging{
      {0.5, 0, 0.3},
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()))};
  add_transform("/tf_static", 0, "base_link", "laser", hanging);
  drive(1);
  const Reading reading = read().observations.at(0).readings.at(0);
  EXPECT_LT(boxminus(reading.T_robot_sensor, Pose::planar(0.5, 0, 0)).norm(), 1e-9);
  const Eigen::Vector3d p_robot = hanging * (2 * Eigen::Vector3d(std::cos(0.5), std::sin(0.5), 0));
  const Eigen::Vector3d ours = reading.T_robot_sensor * reading.points_sensor.at(1).cast<double>();
  EXPECT_LT((ours - p_robot).head<2>().norm(), 1e-6);
}

TEST_F(RecordedLog, ScansOfATiltedLaserAreLost) {
  drive(3);
  const Pose tilted{{0, 0, 0},
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()))};
  messages_.insert(messages_.begin(),
                   SampleMessage{"/tf_static", "tf2_msgs/TFMessage", kStart,
                                 transforms(out(), {{0, "base_link", "laser", tilted}})});
  EXPECT_THAT(reason(), HasSubstr("tilted laser"));
}

TEST_F(RecordedLog, WithoutOdometryMessagesTheTransformBelowOdomIsTaken) {
  for (int k = 0; k < 6; ++k) {
    const int64_t stamp = kStart + k * kSecond / 2;
    add_transform("/tf", stamp, "map", "odom", Pose::planar(100, 0, 0));
    add_transform("/tf", stamp, "odom", "base_footprint", Pose::planar(0.5 * k, 0, 0));
    add_transform("/tf", stamp, "base_footprint", "laser", Pose::planar(0.1, 0, 0));
    if (k < 5) add_scan(stamp + kSecond / 4);
  }
  const ReadLog log = read();
  ASSERT_EQ(log.observations.size(), 5u);
  EXPECT_NEAR(log.observations[2].T_odom_robot.translation.x(), 1.25, 1e-9);
  EXPECT_NEAR(log.observations[2].readings[0].T_robot_sensor.translation.x(), 0.1, 1e-9);
}

TEST_F(RecordedLog, WhatIsAmbiguousIsAskedFor) {
  drive(3);
  add_scan(kStart + kSecond, "/rear");
  EXPECT_THAT(reason(),
              HasSubstr("choose with --scan-topic: /scan (sensor_msgs/LaserScan), /rear"));
  EXPECT_EQ(read({{"/scan"}, "", ""}).observations.size(), 3u);
  EXPECT_THAT(reason({{"/front"}, "", ""}), HasSubstr("no scan topic /front; there are: /scan"));
  add_odometry(kStart, "/wheels");
  EXPECT_THAT(reason({{"/scan"}, "", ""}), HasSubstr("choose with --odom-topic: /odom"));
  EXPECT_EQ(read({{"/scan"}, "/odom", ""}).observations.size(), 3u);
  EXPECT_THAT(reason({{"/scan"}, "/none", ""}), HasSubstr("no odometry topic /none"));
}

TEST_F(RecordedLog, SeveralScannersBecomeReadingsOfOneObservation) {
  for (int k = 0; k < 4; ++k) {
    add_odometry(kStart + k * kSecond / 2);
    add_scan(kStart + k * kSecond / 2 + kSecond / 4, "/front");
    add_scan(kStart + k * kSecond / 2 + kSecond / 4 + kSecond / 10, "/rear", "rear");
  }
  add_odometry(kStart + 2 * kSecond);
  const ReadLog log = read({{"/front", "/rear"}, "", ""});
  ASSERT_EQ(log.observations.size(), 4u);
  ASSERT_EQ(log.observations[1].readings.size(), 2u);
  EXPECT_EQ(log.observations[1].readings[1].sensor, 1);
  // It was seen a tenth of a second, so 0.1 m, later.
  EXPECT_NEAR(log.observations[1].readings[1].T_robot_sensor.translation.x(), 0.1, 1e-9);
}

TEST_F(RecordedLog, CloudsMakeALogInSpace) {
  add_transform("/tf_static", 0, "base_link", "lidar",
                {{0, 0, 1.5}, Eigen::Quaterniond::Identity()});
  for (int k = 0; k < 3; ++k) {
    add_odometry(kStart + k * kSecond);
    add("/points", "sensor_msgs/PointCloud2", kStart + k * kSecond + kDelay,
        cloud(out(), kStart + k * kSecond, "lidar", {{1, 2, 2}, {0, 0, 0}}));
  }
  const ReadLog log = read();
  ASSERT_EQ(log.observations.size(), 3u);
  EXPECT_EQ(log.space, Space::se3);
  const Reading& reading = log.observations[0].readings[0];
  EXPECT_EQ(reading.T_robot_sensor.translation.z(), 1.5);
  EXPECT_THAT(reading.points_sensor, ElementsAre(Eigen::Vector3f(1, 2, 2)));
  EXPECT_EQ(reading.max_range_m, 3);
}

TEST_F(RecordedLog, ScansWithoutOdometryAreLostAndCounted) {
  drive(4);
  // Ten more seconds of scans; the first comes within what odometry is held.
  for (int k = 0; k < 20; ++k) add_scan(kStart + 2 * kSecond + kSecond / 10 + k * kSecond / 2);
  const ReadLog log = read();
  EXPECT_EQ(log.observations.size(), 5u);
  EXPECT_EQ(log.report.losses.at("scans without odometry at their time"), 19);
}

TEST_F(RecordedLog, GapsOfTheOdometryCostTheScansInside) {
  drive(4);
  for (int k = 0; k < 4; ++k) add_scan(kStart + 3 * kSecond + k * kSecond);
  for (int k = 14; k < 20; ++k) add_odometry(kStart + k * kSecond / 2);
  const ReadLog log = read();
  EXPECT_EQ(log.observations.size(), 4u);
  EXPECT_EQ(log.report.losses.at("scans without odometry at their time"), 4);
}

TEST_F(RecordedLog, TwoClocksAreBridgedByTheTimesOfReceipt) {
  for (int k = 0; k < 10; ++k) {
    const int64_t now = kStart + k * kSecond / 2;
    add_odometry(now);
    // The scanner's clock starts with its power.
    const test::SampleScan scan{k * kSecond / 2 + 1, "laser", 0, 0.5, 0, 30, {1, 2}};
    add("/scan", "sensor_msgs/LaserScan", now + kSecond / 4 + kDelay, laser_scan(out(), scan));
  }
  add_odometry(kStart + 5 * kSecond);
  const ReadLog log = read();
  ASSERT_EQ(log.observations.size(), 10u);
  EXPECT_NEAR(log.observations[3].T_odom_robot.translation.x(), 1.75, 1e-6);
  EXPECT_NEAR(log.observations[3].stamp_s, 1.5, 1e-6);
  EXPECT_EQ(log.report.notes.count(
                "scans and odometry have different clocks: their times of receipt are taken"),
            1u);
}

TEST_F(RecordedLog, StampsOfZeroAreReplacedAndBadOnesCostOnlyTheirScan) {
  drive(2);
  const test::SampleScan zero{0, "laser", 0, 0.5, 0, 30, {1, 2}};
  add("/scan", "sensor_msgs/LaserScan", kStart + kSecond, laser_scan(out(), zero));
  add_scan(kStart + 60 * 86400 * 365 * kSecond);
  messages_.back().received_ns = kStart + kSecond;
  add_odometry(kStart + kSecond + kSecond / 2);
  const ReadLog log = read();
  EXPECT_EQ(log.observations.size(), 3u);
  EXPECT_EQ(log.report.notes.at("stamps of 0: the time of receipt is taken"), 1);
  EXPECT_EQ(log.report.losses.at("scans without odometry at their time"), 1);
}

TEST_F(RecordedLog, DamagedMessagesAreCounted) {
  drive(3);
  add("/scan", "sensor_msgs/LaserScan", kStart + kSecond, "short");
  add("/odom", "nav_msgs/Odometry", kStart + kSecond, "");
  const ReadLog log = read();
  EXPECT_EQ(log.observations.size(), 3u);
  EXPECT_EQ(log.report.losses.size(), 2u);
}

TEST_F(RecordedLog, WithoutScansOrOdometryItSaysWhatIsThere) {
  add("/chat", "std_msgs/String", kStart, "....");
  EXPECT_THAT(reason(), HasSubstr("no scans"));
  EXPECT_THAT(reason(), HasSubstr("/chat (std_msgs/String)"));
  add_scan(kStart);
  EXPECT_THAT(reason(), HasSubstr("no odometry"));
  EXPECT_THAT(reason(), HasSubstr("--odom-topic none"));
}

TEST_F(RecordedLog, IsReadWithoutOdometryWhereThatIsWanted) {
  add_transform("/tf_static", kStart, "base_link", "laser", Pose::planar(0.2, 0, 0));
  for (int k = 0; k < 4; ++k) add_scan(kStart + k * kSecond);
  // Far away in time, so that none is nearer than a second.
  add_scan(kStart + 1000 * kSecond);
  LogOptions without;
  without.odometry_topic = "none";
  const ReadLog log = read(without);
  ASSERT_EQ(log.observations.size(), 5u);
  EXPECT_TRUE(log.report.losses.empty());
  for (const Observation& observation : log.observations) {
    EXPECT_EQ(observation.T_odom_robot, Pose{});
    EXPECT_NEAR(observation.readings.at(0).T_robot_sensor.translation.x(), 0.2, 1e-12);
  }
  WireWriter tag(Wire::ros1);
  add("/tags", "apriltag_ros/AprilTagDetectionArray", kStart,
      tag.header(kStart, "laser").number(uint32_t{0}).bytes());
  EXPECT_THAT(reason(without), HasSubstr("have to be carried"));
}

TEST_F(RecordedLog, TheSummaryListsTopicsRatesAndFrames) {
  drive(4);
  add_transform("/tf_static", kStart, "base_link", "laser", Pose{});
  const auto summary = summarize_recording(write(), submap::Run{});
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->topics.size(), 3u);
  EXPECT_EQ(summary->topics[0].name, "/odom");
  EXPECT_EQ(summary->topics[0].messages, 5);
  EXPECT_NEAR(summary->topics[0].rate_hz, 2, 1e-6);
  EXPECT_THAT(summary->topics[0].frames, ElementsAre("odom -> base_link"));
  EXPECT_THAT(summary->topics[1].frames, ElementsAre("laser"));
  EXPECT_THAT(summary->topics[2].frames, ElementsAre("base_link -> laser"));
  test::write_file(folder_.path() / "log.txt", "FLASER 0\n");
  EXPECT_FALSE(summarize_recording(folder_.path() / "log.txt", submap::Run{}));
}

// The same drive out of each container is the same log.
TEST(SimulatedRecording, IsTheSameLogInEveryFormat) {
  const test::TemporaryFolder folder;
  const auto ros1 = test::simulated_messages({"rooms", 3, 1}, Wire::ros1, 60);
  const auto ros2 = test::simulated_messages({"rooms", 3, 1}, Wire::cdr, 60);
  test::write_file(folder.path() / "a.bag", test::ros1_bag(ros1, {"bz2", 50}));
  test::write_file(folder.path() / "a.mcap", test::mcap_file(ros2, {"zstd", 50}));
  test::write_sqlite_bag(folder.path() / "a.db3", ros2);
  const SimulatedLog truth = simulate({"rooms", 3, 1});
  for (const char* name : {"a.bag", "a.mcap", "a.db3"}) {
    const auto reader = open_log(folder.path() / name);
    for (size_t k = 0; k < 60; ++k) {
      const auto observation = reader->next();
      const Observation& wanted = truth.observations[k];
      ASSERT_TRUE(observation);
      ASSERT_NEAR(observation->stamp_s, wanted.stamp_s, 1e-9);
      ASSERT_LT(boxminus(observation->T_odom_robot, wanted.T_odom_robot).norm(), 1e-12);
      ASSERT_LT(boxminus(observation->readings[0].T_robot_sensor, wanted.readings[0].T_robot_sensor)
                    .norm(),
                1e-12);
      ASSERT_EQ(observation->readings[0].points_sensor.size(),
                wanted.readings[0].points_sensor.size());
      for (size_t i = 0; i < wanted.readings[0].points_sensor.size(); ++i)
        ASSERT_LT((observation->readings[0].points_sensor[i] - wanted.readings[0].points_sensor[i])
                      .norm(),
                  1e-4);
    }
    EXPECT_FALSE(reader->next());
    EXPECT_TRUE(reader->report().losses.empty());
  }
}

}  // namespace
}  // namespace hmt::submap
