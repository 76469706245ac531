// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Markers in recordings: from messages to landmarks of the observation next to them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hmt/submap/log/recording_summary.hpp"
#include "log/ros/markers_message.hpp"
#include "recordings/marker_messages.hpp"
#include "recordings/recording_writers.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using test::SampleMarker;
using test::WireWriter;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int64_t kSecond = 1'000'000'000;
constexpr int64_t kStart = 1'600'000'000 * kSecond;

SampleMarker marker(int64_t name, double x, double y, double z, double variance = 0) {
  return {name, {x, y, z}, variance * Eigen::Matrix3d::Identity()};
}

// What is written is read again, in both wires and byte orders.
TEST(MarkerMessages, TellNamesAndPlaces) {
  std::vector<SampleMarker> markers = {marker(7, 1, 2, 3, 0.04), marker(300, -1, 0.5, 4, 0.01)};
  markers[0].covariance(0, 2) = markers[0].covariance(2, 0) = 0.01;
  const auto check = [&](const std::string& bytes, Wire wire, MessageKind kind, bool is_told) {
    const MarkersMessage message = read_markers({bytes, wire}, kind);
    EXPECT_EQ(message.header, (MessageHeader{kStart, "camera"}));
    ASSERT_EQ(message.markers.size(), 2u);
    for (size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(message.markers[k].name, markers[k].name);
      EXPECT_EQ(message.markers[k].position, markers[k].position);
      EXPECT_EQ(message.markers[k].covariance,
                is_told ? markers[k].covariance : Eigen::Matrix3d::Zero().eval());
    }
  };
  for (const Wire wire : {Wire::ros1, Wire::cdr})
    for (const bool little : {true, false}) {
      if (wire == Wire::ros1 && !little) continue;
      const WireWriter out(wire, little);
      check(april_tags(out, kStart, "camera", markers), wire, MessageKind::april_tags, true);
      check(aruco_markers(out, kStart, "camera", markers), wire, MessageKind::aruco_markers, false);
      check(aruco_detection(out, kStart, "camera", markers), wire, MessageKind::aruco_detection,
            false);
      check(detections(out, kStart, "camera", markers), wire, MessageKind::detections, true);
    }
}

TEST(MarkerMessages, KindsAreToldByType) {
  EXPECT_EQ(message_kind("apriltag_ros/AprilTagDetectionArray"), MessageKind::april_tags);
  EXPECT_EQ(message_kind("aruco_opencv_msgs/msg/ArucoDetection"), MessageKind::aruco_detection);
  EXPECT_EQ(message_kind("ros2_aruco_interfaces/msg/ArucoMarkers"), MessageKind::aruco_markers);
  EXPECT_EQ(message_kind("vision_msgs/msg/Detection3DArray"), MessageKind::detections);
  EXPECT_EQ(message_kind("vision_msgs/Detection3DArray"), MessageKind::other);
}

TEST(MarkerMessages, WhatIsNoPlaceOrNoCovarianceIsRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SampleMarker skew = marker(5, 1, 0, 0, 0.01);
  skew.covariance(0, 1) = 0.005;
  SampleMarker negative = marker(6, 1, 0, 0, 0.01);
  negative.covariance(1, 1) = -0.01;
  const std::vector<SampleMarker> markers = {marker(1, nan, 0, 0),
                                             marker(1, 1, nan, 0),
                                             marker(2, 1e9, 0, 0),
                                             marker(3, 1, 0, 0, nan),
                                             marker(4, 1, 0, 0, 1e300),
                                             skew,
                                             negative,
                                             marker(7, 1, 0, 0, 1e-20),
                                             marker(-8, 1, 0, 0, 0.01)};
  const MarkersMessage message =
      read_markers({april_tags(WireWriter(Wire::ros1), kStart, "camera", markers), Wire::ros1},
                   MessageKind::april_tags);
  EXPECT_EQ(message.refused, 7);
  EXPECT_EQ(message.unnamed, 1);
  // Finer than anything measures is as fine as it gets.
  ASSERT_EQ(message.markers.size(), 1u);
  EXPECT_EQ(message.markers[0].name, 7);
  EXPECT_TRUE(message.markers[0].covariance.isApprox(1e-6 * Eigen::Matrix3d::Identity()));
}

TEST(MarkerMessages, BundlesAndTextsAreNoNames) {
  WireWriter bundle(Wire::ros1);
  bundle.header(kStart, "camera").number(uint32_t{1});
  bundle.number(uint32_t{2}).number(int32_t{1}).number(int32_t{2});
  bundle.number(uint32_t{2}).number(0.1).number(0.1);
  bundle.header(kStart, "camera");
  pose_with_covariance(bundle, marker(0, 1, 2, 3));
  const MarkersMessage message =
      read_markers({bundle.bytes(), Wire::ros1}, MessageKind::april_tags);
  EXPECT_EQ(message.unnamed, 1);
  EXPECT_THAT(message.markers, IsEmpty());

  std::string text = detections(WireWriter(Wire::ros1), kStart, "camera", {marker(12, 1, 2, 3)});
  text.back() = 'x';  // "1x"
  EXPECT_EQ(read_markers({text, Wire::ros1}, MessageKind::detections).unnamed, 1);
}

TEST(MarkerMessages, CutOnesAndCountsThatLieAreRefused) {
  const std::vector<SampleMarker> one = {marker(1, 1, 2, 3, 0.1)};
  for (const Wire wire : {Wire::ros1, Wire::cdr}) {
    const WireWriter out(wire);
    const std::pair<MessageKind, std::string> messages[] = {
        {MessageKind::april_tags, april_tags(out, kStart, "c", one)},
        {MessageKind::aruco_markers, aruco_markers(out, kStart, "c", one)},
        {MessageKind::aruco_detection, aruco_detection(out, kStart, "c", one)},
        {MessageKind::detections, detections(out, kStart, "c", one)}};
    for (const auto& [kind, bytes] : messages) {
      // The boards behind the markers are not read.
      const size_t end = bytes.size() - (kind == MessageKind::aruco_detection ? 8 : 0);
      for (size_t size = 0; size < end; ++size)
        EXPECT_THROW(read_markers({std::string_view(bytes).substr(0, size), wire}, kind),
                     MessageError);
    }
  }
  WireWriter many(Wire::ros1);
  many.header(kStart, "c").number(uint32_t{0xffffffff});
  for (const MessageKind kind : {MessageKind::april_tags, MessageKind::aruco_markers,
                                 MessageKind::aruco_detection, MessageKind::detections})
    EXPECT_THROW(read_markers({many.bytes(), Wire::ros1}, kind), MessageError);
}

LogOptions topic(const std::string& name) {
  LogOptions options;
  options.landmark_topics = {name};
  return options;
}

/// A robot that drives along x at 1 m/s with odometry at 0, 0.1, ... s and scans at 0, 0.5, ... s.
/// Its camera looks ahead from 0.2 m ahead and 1 m up, its z axis points ahead, its x axis right.
class MarkedLog : public testing::Test {
 protected:
  void drive(double seconds, bool with_scans = true) {
    Eigen::Matrix3d R;
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    add("/tf_static", "tf2_msgs/TFMessage", 0,
        transforms(out(), {{kStart, "base_link", "camera", {{0.2, 0, 1}, Eigen::Quaterniond(R)}},
                           {kStart, "base_link", "laser", {}}}));
    for (int k = 0; k <= static_cast<int>(10 * seconds); ++k) {
      add("/odom", "nav_msgs/Odometry", 0.1 * k,
          odometry(out(), kStart + k * kSecond / 10, Pose::planar(0.1 * k, 0, 0)));
      const test::SampleScan scan{kStart + k * kSecond / 10, "laser", 0, 0.5, 0, 30, {1, 2}};
      if (with_scans && k % 5 == 0)
        add("/scan", "sensor_msgs/LaserScan", 0.1 * k, laser_scan(out(), scan));
    }
  }
  /// A message that is received a tenth of a second after its stamp.
  void see(double stamp_s, const std::vector<SampleMarker>& markers,
           const std::string& topic = "/tags", const std::string& frame = "camera") {
    add(topic, "apriltag_ros/AprilTagDetectionArray", stamp_s + 0.1,
        april_tags(out(), kStart + std::llround(1e9 * stamp_s), frame, markers));
  }
  void add(const std::string& topic, const std::string& type, double received_s,
           const std::string& bytes) {
    messages_.push_back({topic, type, kStart + std::llround(1e9 * received_s), bytes});
  }
  std::unique_ptr<LogReader> open(const LogOptions& options = {}) {
    std::ranges::stable_sort(messages_, {}, &test::SampleMessage::received_ns);
    test::write_file(path(), wire_ == Wire::ros1 ? test::ros1_bag(messages_, {"lz4", 9})
                                                 : test::mcap_file(messages_));
    return open_log(path(), options);
  }
  std::vector<Observation> read(const LogOptions& options = {}) {
    const auto reader = open(options);
    std::vector<Observation> observations;
    while (auto observation = reader->next()) observations.push_back(std::move(*observation));
    report_ = reader->report();
    return observations;
  }
  WireWriter out() const { return WireWriter(wire_); }
  std::filesystem::path path() const { return folder_.path() / "log"; }

  test::TemporaryFolder folder_;
  Wire wire_ = Wire::ros1;
  std::vector<test::SampleMessage> messages_;
  LogReport report_;
};

TEST_F(MarkedLog, MarkersJoinTheScanNextInTimeByOdometry) {
  drive(3);
  // At 1.2 s the camera is at x = 1.4: 3 m ahead of it and 1 m to the left the marker stands at
  // (4.4, 1). The scan of 1.0 s is next.
  SampleMarker seen = marker(7, -1, -0.5, 3);
  seen.covariance.diagonal() << 0.01, 0.02, 0.09;
  see(1.2, {seen});
  const auto observations = read();
  ASSERT_EQ(observations.size(), 7u);
  for (size_t k = 0; k < 7; ++k)
    EXPECT_EQ(observations[k].landmark_readings.size(), k == 2 ? 1u : 0u) << k;
  const Observation& at = observations[2];
  const LandmarkReading& reading = at.landmark_readings.at(0);
  EXPECT_EQ(reading.sensor, 1);
  ASSERT_EQ(reading.landmarks.size(), 1u);
  EXPECT_EQ(reading.landmarks[0].id, 7);
  const Eigen::Vector3d p_odom =
      at.T_odom_robot * reading.T_robot_sensor * reading.landmarks[0].position_sensor;
  EXPECT_TRUE(p_odom.isApprox(Eigen::Vector3d(4.4, 1, 0))) << p_odom.transpose();
  // Seen from above: depth is x, right is -y.
  const Eigen::Vector3d variances(0.09, 0.01, 0);
  EXPECT_TRUE(
      reading.landmarks[0].covariance_sensor.isApprox(Eigen::Matrix3d(variances.asDiagonal())));
  EXPECT_THAT(report_.losses, IsEmpty());
}

TEST_F(MarkedLog, InSpaceTheyStandWhereTheCameraSawThem) {
  drive(2, false);
  for (int k = 0; k <= 4; ++k)
    add("/points", "sensor_msgs/PointCloud2", 0.5 * k,
        cloud(out(), kStart + k * kSecond / 2, "laser", {{1, 2, 3}, {4, 5, 6}}));
  see(1.1, {marker(7, -1, -0.5, 3, 0.01)});
  const auto observations = read();
  ASSERT_EQ(observations.size(), 5u);
  const Observation& at = observations[2];
  const LandmarkReading& reading = at.landmark_readings.at(0);
  const Eigen::Vector3d p_odom =
      at.T_odom_robot * reading.T_robot_sensor * reading.landmarks.at(0).position_sensor;
  EXPECT_TRUE(p_odom.isApprox(Eigen::Vector3d(4.3, 1, 1.5))) << p_odom.transpose();
  EXPECT_TRUE(reading.landmarks[0].covariance_sensor.isApprox(0.01 * Eigen::Matrix3d::Identity()));
}

TEST_F(MarkedLog, WhatCannotBeJoinedIsCountedAsLost) {
  drive(3);
  see(2.9, {marker(1, 0, 0, 3)});
  see(4.5, {marker(1, 0, 0, 3)});                      // 1.5 s behind the last scan
  see(1.0, {marker(1, 0, 0, 3)}, "/tags", "nowhere");  // no mount
  see(1.1, {marker(2, 0, 0, 3, -1), marker(-3, 0, 0, 3)});
  add("/tags", "apriltag_ros/AprilTagDetectionArray", 1.3, "damaged");
  const auto observations = read();
  EXPECT_EQ(observations.back().landmark_readings.size(), 1u);
  EXPECT_EQ(report_.losses.at("landmarks more than a second from any scan"), 1);
  EXPECT_EQ(report_.losses.at("landmarks left out: no transform from frame base_link to nowhere"),
            1);
  EXPECT_EQ(report_.losses.at("landmarks whose position or covariance is none on /tags"), 1);
  EXPECT_EQ(report_.notes.at("landmarks left out: without a name that is one number"), 1);
  EXPECT_EQ(report_.losses.at("damaged messages on /tags: message ends early"), 1);
}

TEST_F(MarkedLog, TopicsMayBeChosen) {
  drive(2);
  see(1.0, {marker(1, 0, 0, 3)}, "/front");
  see(1.0, {marker(2, 0, 0, 3)}, "/back");
  add("/people", "vision_msgs/Detection3DArray", 1.0, "");
  const auto sensors = [&](const LogOptions& options) {
    std::vector<int64_t> names;
    for (const Observation& observation : read(options))
      for (const LandmarkReading& reading : observation.landmark_readings)
        names.push_back(reading.landmarks.at(0).id);
    return names;
  };
  EXPECT_THAT(sensors({}), ElementsAre(1, 2));
  EXPECT_THAT(sensors(topic("/back")), ElementsAre(2));
  EXPECT_THAT(sensors(topic("none")), IsEmpty());
  EXPECT_THROW(open(topic("/side")), InputError);
}

// What an object detector finds may walk away, so it has to be asked for.
TEST_F(MarkedLog, DetectionsOfAnythingAreReadWhereTheyAreNamed) {
  wire_ = Wire::cdr;
  drive(2);
  add("/objects", "vision_msgs/Detection3DArray", 1.1,
      detections(out(), kStart + kSecond, "camera", {marker(5, 0, 0, 3)}));
  for (const Observation& observation : read())
    EXPECT_THAT(observation.landmark_readings, IsEmpty());
  const auto observations = read(topic("/objects"));
  EXPECT_EQ(observations.at(2).landmark_readings.at(0).landmarks.at(0).id, 5);
}

TEST_F(MarkedLog, WithoutScansMarkersAreTheLog) {
  drive(2, false);
  for (int k = 0; k < 4; ++k) see(0.3 + 0.4 * k, {marker(k, 0, 0, 3), marker(9, 1, 0, 3)});
  const auto reader = open();
  EXPECT_TRUE(reader->has_landmarks_only());
  const auto observations = read();
  ASSERT_EQ(observations.size(), 4u);
  for (size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(observations[k].T_odom_robot.translation.x(), 0.3 + 0.4 * static_cast<double>(k),
                1e-6);
    EXPECT_THAT(observations[k].readings, IsEmpty());
    ASSERT_EQ(observations[k].landmark_readings.size(), 1u);
    EXPECT_EQ(observations[k].landmark_readings[0].landmarks.size(), 2u);
  }
}

TEST_F(MarkedLog, InfoListsTheTopicAndItsFrame) {
  drive(1);
  see(0.5, {marker(1, 0, 0, 3)});
  open();
  const auto summary = summarize_recording(path(), {});
  ASSERT_TRUE(summary);
  const auto topic = std::ranges::find(summary->topics, "/tags", &TopicSummary::name);
  ASSERT_NE(topic, summary->topics.end());
  EXPECT_EQ(topic->messages, 1);
  EXPECT_THAT(topic->frames, ElementsAre("camera"));
}

}  // namespace
}  // namespace hmt::submap
