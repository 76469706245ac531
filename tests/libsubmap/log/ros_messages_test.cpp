// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "log/ros/messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "log/ros/transform_tree.hpp"
#include "recordings/wire_writer.hpp"

namespace hmt::submap {
namespace {

using graph::Pose;
using test::WireWriter;

/// Both wires, CDR in both byte orders.
std::vector<std::pair<WireWriter, Wire>> wires() {
  return {{WireWriter(Wire::ros1), Wire::ros1},
          {WireWriter(Wire::cdr), Wire::cdr},
          {WireWriter(Wire::cdr, false), Wire::cdr}};
}

const Pose kPose{{1, -2, 0.5}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)};
constexpr int64_t kStamp = 1'600'000'000'250'000'000;

TEST(RosMessages, AScanIsTheSameOutOfEveryWire) {
  const test::SampleScan sample{kStamp, "/laser", -1, 0.5, 0.1F, 30, {1, 2, 3}};
  for (const auto& [out, wire] : wires())
    for (const bool echoes : {false, true}) {
      const std::string bytes = laser_scan(out, sample, echoes);
      const auto scan = read_laser_scan(
          {bytes, wire}, echoes ? MessageKind::multi_echo_scan : MessageKind::laser_scan);
      EXPECT_EQ(scan.header, (MessageHeader{kStamp, "laser"}));
      EXPECT_EQ(scan.angle_min_rad, -1);
      EXPECT_EQ(scan.angle_increment_rad, 0.5);
      EXPECT_EQ(scan.range_max_m, 30);
      EXPECT_EQ(scan.ranges_m, sample.ranges);
    }
}

TEST(RosMessages, OdometryIsTheSameOutOfEveryWire) {
  for (const auto& [out, wire] : wires()) {
    const std::string bytes = odometry(out, kStamp, kPose, "/base");
    const auto message = read_odometry({bytes, wire});
    EXPECT_EQ(message.header, (MessageHeader{kStamp, "odom"}));
    EXPECT_EQ(message.child_frame, "base");
    EXPECT_LT(boxminus(message.T_odom_robot, kPose).norm(), 1e-12);
  }
}

TEST(RosMessages, ACloudIsTheSameOutOfEveryWireAndByteOrder) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector3f> points = {{1, 2, 3}, {nan, 0, 0}, {0, 0, 0}, {-4, 5, 1e30F}};
  for (const auto& [out, wire] : wires())
    for (const bool big_endian : {false, true}) {
      const std::string bytes = cloud(out, kStamp, "lidar", points, big_endian);
      const auto message = read_cloud({bytes, wire});
      ASSERT_EQ(message.cloud.points.size(), 1u);
      EXPECT_EQ(message.cloud.points[0], points[0]);
      EXPECT_EQ(message.cloud.not_finite, 2);
      EXPECT_EQ(message.cloud.at_origin, 1);
    }
}

TEST(RosMessages, WhatIsNoPoseIsRefused) {
  const WireWriter out(Wire::cdr);
  Pose zero = kPose;
  zero.rotation.coeffs().setZero();
  Pose nowhere = kPose;
  nowhere.translation.x() = std::nan("");
  for (const Pose& pose : {zero, nowhere})
    EXPECT_THROW(read_odometry({odometry(out, 0, pose), Wire::cdr}), MessageError);
  const auto message = read_transforms(
      {transforms(out, {{1, "a", "b", kPose}, {1, "a", "c", zero}, {1, "d", "d", kPose}}),
       Wire::cdr});
  EXPECT_EQ(message.transforms.size(), 1u);
  EXPECT_EQ(message.refused, 2);
}

TEST(RosMessages, CutMessagesAreRefusedAtEveryByte) {
  const test::SampleScan sample{kStamp, "laser", -1, 0.5, 0.1F, 30, {1, 2, 3}};
  for (const auto& [out, wire] : wires()) {
    // The intensities behind the ranges are not read.
    const std::string scan = laser_scan(out, sample);
    for (size_t size = 0; size + 4 < scan.size(); ++size)
      EXPECT_THROW(
          read_laser_scan({std::string_view(scan).substr(0, size), wire}, MessageKind::laser_scan),
          MessageError);
    const std::string points = cloud(out, kStamp, "lidar", {{1, 2, 3}});
    for (size_t size = 0; size + 1 < points.size(); ++size)
      EXPECT_THROW(read_cloud({std::string_view(points).substr(0, size), wire}), MessageError);
  }
}

TEST(RosMessages, CountsAndStepsThatLieAreRefused) {
  WireWriter scan(Wire::ros1);
  scan.header(kStamp, "laser");
  for (int k = 0; k < 7; ++k) scan.number(1.F);
  scan.number(uint32_t{0xffffffff});
  EXPECT_THROW(read_laser_scan({scan.bytes(), Wire::ros1}, MessageKind::laser_scan), MessageError);

  test::SampleScan still{kStamp, "laser", 0, 0, 0, 30, {1, 2}};  // angle_increment 0
  EXPECT_THROW(read_laser_scan({laser_scan(WireWriter(Wire::ros1), still), Wire::ros1},
                               MessageKind::laser_scan),
               MessageError);

  std::string points = cloud(WireWriter(Wire::ros1), kStamp, "l", {{1, 2, 3}});
  const size_t width = 12 + 4 + 1 + 4;  // behind the header and the height
  points[width + 3] = 0x7f;
  EXPECT_THROW(read_cloud({points, Wire::ros1}), MessageError);
  points = cloud(WireWriter(Wire::ros1), kStamp, "l", {{1, 2, 3}});
  const size_t step = points.size() - 1 - 16 - 4 - 4 - 4;
  points[step] = 0;  // point_step 0
  EXPECT_THROW(read_cloud({points, Wire::ros1}), MessageError);
}

TEST(RosMessages, KindsAreToldByBothSpellingsOfTheType) {
  EXPECT_EQ(message_kind("sensor_msgs/LaserScan"), MessageKind::laser_scan);
  EXPECT_EQ(message_kind("sensor_msgs/msg/LaserScan"), MessageKind::laser_scan);
  EXPECT_EQ(message_kind("tf/tfMessage"), MessageKind::transforms);
  EXPECT_EQ(message_kind("tf2_msgs/msg/TFMessage"), MessageKind::transforms);
  EXPECT_EQ(message_kind("my_msgs/LaserScan"), MessageKind::other);
  EXPECT_EQ(message_kind(""), MessageKind::other);
}

TransformMessage transform(const std::string& parent, const std::string& child, int64_t stamp_ns,
                           double x_m) {
  return {{stamp_ns, parent}, child, Pose::planar(x_m, 0, 0)};
}

// map -> odom -> base -> laser, and base -> arm
TEST(TransformTree, JoinsFramesOverTheirCommonAncestor) {
  TransformTree tree;
  tree.add(transform("odom", "base", 0, 1), false);
  tree.add(transform("odom", "base", 1'000'000'000, 3), false);
  tree.add(transform("base", "laser", 0, 0.25), true);
  tree.add(transform("base", "arm", 0, -0.5), true);
  EXPECT_EQ(tree.ancestry("laser"), (std::vector<std::string>{"laser", "base", "odom"}));
  EXPECT_DOUBLE_EQ(tree.find("arm", "laser", 7)->translation.x(), 0.75);
  EXPECT_DOUBLE_EQ(tree.find("odom", "laser", 500'000'000)->translation.x(), 2.25);
  // Beyond its ends a moving transform stays where it was.
  EXPECT_DOUBLE_EQ(tree.find("odom", "base", 9'000'000'000)->translation.x(), 3);
  EXPECT_DOUBLE_EQ(tree.find("laser", "odom", 0)->translation.x(), -1.25);
  EXPECT_FALSE(tree.find("laser", "elsewhere", 0));
  EXPECT_TRUE(tree.find("elsewhere", "elsewhere", 0));
}

TEST(TransformTree, ACircleEndsTheSearch) {
  TransformTree tree;
  tree.add(transform("a", "b", 0, 1), true);
  tree.add(transform("b", "c", 0, 1), true);
  tree.add(transform("c", "a", 0, 1), true);
  EXPECT_EQ(tree.ancestry("c").size(), 3u);
  EXPECT_FALSE(tree.find("c", "x", 0));
  EXPECT_TRUE(tree.find("a", "c", 0));
}

TEST(PoseHistory, InterpolatesWithinGapsAndHoldsShortly) {
  constexpr int64_t kSecond = 1'000'000'000;
  PoseHistory history;
  EXPECT_FALSE(history.at(0));
  EXPECT_TRUE(history.add(0, Pose::planar(0, 0, 0)));
  EXPECT_TRUE(history.add(kSecond, Pose::planar(2, 0, 0.5)));
  EXPECT_FALSE(history.add(kSecond, Pose::planar(9, 0, 0)));
  EXPECT_TRUE(history.add(5 * kSecond, Pose::planar(6, 0, 0)));
  EXPECT_DOUBLE_EQ(history.between(kSecond / 4)->translation.x(), 0.5);
  EXPECT_NEAR(history.between(kSecond / 4)->yaw_rad(), 0.125, 1e-12);
  EXPECT_FALSE(history.between(2 * kSecond));
  EXPECT_FALSE(history.at(2 * kSecond));
  EXPECT_EQ(history.at(kSecond + kSecond / 10)->translation.x(), 2);
  EXPECT_EQ(history.at(-kSecond / 10)->translation.x(), 0);
  EXPECT_FALSE(history.at(-kSecond));
  EXPECT_EQ(history.nearest(-kSecond)->translation.x(), 0);
  EXPECT_FALSE(history.at(std::numeric_limits<int64_t>::min()));
}

TEST(RosMessages, TurnRatesThatAreNoneAreRefusedWhereverTheyStand) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), 1e9})
    for (int k = 0; k < 3; ++k) {
      Eigen::Vector3d rates(0.1, 0.2, 0.3);
      rates[k] = bad;
      const std::string bytes = test::imu(WireWriter(Wire::cdr), 0, "imu", rates);
      EXPECT_THROW(read_imu({bytes, Wire::cdr}), MessageError) << bad << " at " << k;
    }
}

}  // namespace
}  // namespace hmt::submap
