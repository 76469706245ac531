// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "../cloud/point_layout.hpp"
#include "hmt/graph/pose.hpp"
#include "wire.hpp"

namespace hmt::submap {

// The messages that a map is made of, out of either wire format. Each read_x throws MessageError
// for one that is cut or contradicts itself.

/// What kind of message a topic carries, for us.
enum class MessageKind {
  laser_scan,
  multi_echo_scan,
  cloud,
  april_tags,       ///< apriltag_ros/AprilTagDetectionArray
  aruco_markers,    ///< ros2_aruco_interfaces/ArucoMarkers
  aruco_detection,  ///< aruco_opencv_msgs/ArucoDetection
  detections,       ///< vision_msgs/msg/Detection3DArray, of ROS 2 only: that of ROS 1 has no ids
  odometry,
  transforms,
  imu,
  other
};

/// By its type: "sensor_msgs/LaserScan", and the same in the spelling of ROS 2,
/// "sensor_msgs/msg/LaserScan".
MessageKind message_kind(std::string_view type);
/// Whether messages of this kind are what a range sensor saw.
bool is_range_data(MessageKind kind);
/// Whether messages of this kind are landmarks with names, and how they stand to the sensor.
bool is_landmark_data(MessageKind kind);

/// Without the leading slash that old ROS 1 logs have.
std::string frame_name(std::string_view name);

struct MessageHeader {
  int64_t stamp_ns = 0;
  std::string frame;

  bool operator==(const MessageHeader&) const = default;
};

/// The header that the messages of all kinds but `transforms` begin with.
MessageHeader read_header(WireReader& in);

/// A planar scan; of several echoes the first.
struct LaserScanMessage {
  MessageHeader header;
  double angle_min_rad = 0;
  double angle_increment_rad = 0;
  double range_min_m = 0;
  double range_max_m = 0;
  double time_increment_s = 0;  ///< between beams; 0 if it is not told or cannot be
  std::vector<double> ranges_m;
};
LaserScanMessage read_laser_scan(WireReader in, MessageKind kind);

struct CloudMessage {
  MessageHeader header;
  CloudPoints cloud;
};
CloudMessage read_cloud(WireReader in);

struct OdometryMessage {
  MessageHeader header;
  std::string child_frame;
  graph::Pose T_odom_robot;
};
OdometryMessage read_odometry(WireReader in);

struct TransformMessage {
  MessageHeader header;  ///< frame: the parent
  std::string child_frame;
  graph::Pose T_parent_child;
};
/// The usable transforms of a message; others are counted in `refused`.
struct TransformMessages {
  std::vector<TransformMessage> transforms;
  int64_t refused = 0;
};
TransformMessages read_transforms(WireReader in);

/// What a gyroscope measured.
struct ImuMessage {
  MessageHeader header;
  Eigen::Vector3d turn_rate = Eigen::Vector3d::Zero();  ///< rad/s, in the frame of the header
};
/// Nothing where the sensor has no gyroscope.
std::optional<ImuMessage> read_imu(WireReader in);

}  // namespace hmt::submap
