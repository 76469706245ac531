// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "messages.hpp"

#include <cmath>
#include <numbers>
#include <optional>

namespace hmt::submap {
namespace {

using graph::Pose;

constexpr int64_t kNanosecondsPerSecond = 1'000'000'000;
/// A unit quaternion that was stored as float and rounded is off by less.
constexpr double kUnitTolerance = 0.1;
/// No robot goes further; larger numbers break what is computed from them.
constexpr double kMaxCoordinate = 1e7;  // metres
constexpr double kLongestSweep_s = 1;
/// What gyroscopes of robots measure at most, and more than those that give degrees would pass for.
constexpr double kMaxTurnRate = 40;  // rad/s
// Bytes of the shortest element of a sequence.
constexpr size_t kLeastTransform = 4 + 4 + 4 + 4 + 56;
constexpr size_t kLeastEcho = 4;

/// Translation and quaternion; nothing for one that is no pose.
std::optional<Pose> read_pose(WireReader& in) {
  double value[7];
  for (double& v : value) v = in.number<double>();
  for (const double v : value)
    if (!std::isfinite(v)) return std::nullopt;
  const Eigen::Vector3d translation(value[0], value[1], value[2]);
  const Eigen::Quaterniond rotation(value[6], value[3], value[4], value[5]);
  if (std::abs(rotation.norm() - 1) > kUnitTolerance) return std::nullopt;
  if (translation.lpNorm<Eigen::Infinity>() > kMaxCoordinate) return std::nullopt;
  return Pose{translation, rotation.normalized()};
}

std::vector<double> read_ranges(WireReader& in) {
  std::vector<double> ranges(in.count(sizeof(float)));
  for (double& range : ranges) range = in.number<float>();
  return ranges;
}

std::vector<double> read_first_echoes(WireReader& in) {
  std::vector<double> ranges(in.count(kLeastEcho));
  for (double& range : ranges) {
    const size_t echoes = in.count(sizeof(float));
    range = std::nan("");
    if (echoes > 0) range = in.number<float>();
    if (echoes > 1) in.skip<float>(echoes - 1);
  }
  return ranges;
}

}  // namespace

std::string frame_name(std::string_view name) {
  if (name.starts_with('/')) name.remove_prefix(1);
  return std::string(name);
}

MessageKind message_kind(std::string_view type) {
  const size_t slash = type.find('/');
  if (slash == std::string_view::npos) return MessageKind::other;
  const std::string_view package = type.substr(0, slash);
  std::string_view name = type.substr(slash + 1);
  if (name.starts_with("msg/")) name.remove_prefix(4);
  if (package == "sensor_msgs") {
    if (name == "LaserScan") return MessageKind::laser_scan;
    if (name == "MultiEchoLaserScan") return MessageKind::multi_echo_scan;
    if (name == "PointCloud2") return MessageKind::cloud;
    if (name == "Imu") return MessageKind::imu;
  }
  if (package == "apriltag_ros" && name == "AprilTagDetectionArray") return MessageKind::april_tags;
  if (package == "ros2_aruco_interfaces" && name == "ArucoMarkers")
    return MessageKind::aruco_markers;
  if (package == "aruco_opencv_msgs" && name == "ArucoDetection")
    return MessageKind::aruco_detection;
  if (type == "vision_msgs/msg/Detection3DArray") return MessageKind::detections;
  if (package == "nav_msgs" && name == "Odometry") return MessageKind::odometry;
  if ((package == "tf2_msgs" && name == "TFMessage") || (package == "tf" && name == "tfMessage"))
    return MessageKind::transforms;
  return MessageKind::other;
}

bool is_range_data(MessageKind kind) {
  return kind == MessageKind::laser_scan || kind == MessageKind::multi_echo_scan ||
         kind == MessageKind::cloud;
}

bool is_landmark_data(MessageKind kind) {
  return kind == MessageKind::april_tags || kind == MessageKind::aruco_markers ||
         kind == MessageKind::aruco_detection || kind == MessageKind::detections;
}

MessageHeader read_header(WireReader& in) {
  MessageHeader header;
  if (!in.is_cdr()) in.skip<uint32_t>(1);  // sequence number
  // Seconds are signed in ROS 2 only; before 2038 that is the same.
  const auto seconds = in.is_cdr() ? int64_t{in.number<int32_t>()} : int64_t{in.number<uint32_t>()};
  header.stamp_ns = seconds * kNanosecondsPerSecond + in.number<uint32_t>();
  header.frame = frame_name(in.text());
  return header;
}

LaserScanMessage read_laser_scan(WireReader in, MessageKind kind) {
  LaserScanMessage scan;
  scan.header = read_header(in);
  scan.angle_min_rad = in.number<float>();
  in.skip<float>(1);  // angle_max
  scan.angle_increment_rad = in.number<float>();
  const double time_increment_s = in.number<float>();
  in.skip<float>(1);  // scan_time
  scan.range_min_m = in.number<float>();
  scan.range_max_m = in.number<float>();
  scan.ranges_m = kind == MessageKind::multi_echo_scan ? read_first_echoes(in) : read_ranges(in);
  const double sweep_s = time_increment_s * static_cast<double>(scan.ranges_m.size());
  if (sweep_s > 0 && sweep_s <= kLongestSweep_s) scan.time_increment_s = time_increment_s;
  if (!std::isfinite(scan.angle_min_rad)) throw MessageError("angle_min is not finite");
  if (!(std::abs(scan.angle_increment_rad) <= 2 * std::numbers::pi))
    throw MessageError("angle_increment is no angle");
  if (scan.angle_increment_rad == 0 && scan.ranges_m.size() > 1)
    throw MessageError("angle_increment is 0");
  return scan;
}

OdometryMessage read_odometry(WireReader in) {
  OdometryMessage odometry;
  odometry.header = read_header(in);
  odometry.child_frame = frame_name(in.text());
  const auto pose = read_pose(in);
  if (!pose) throw MessageError("the pose is not finite, or its quaternion has no length of 1");
  odometry.T_odom_robot = *pose;
  return odometry;
}

std::optional<ImuMessage> read_imu(WireReader in) {
  ImuMessage imu;
  imu.header = read_header(in);
  in.skip<double>(4 + 9);  // orientation and its covariance
  for (double& rate : imu.turn_rate) rate = in.number<double>();
  // A covariance that begins with -1 says that the sensor does not measure it.
  if (in.number<double>() == -1) return std::nullopt;
  // The greatest of some numbers may skip what is none.
  if (!imu.turn_rate.allFinite() || imu.turn_rate.lpNorm<Eigen::Infinity>() > kMaxTurnRate)
    throw MessageError("the angular velocity is none");
  return imu;
}

TransformMessages read_transforms(WireReader in) {
  TransformMessages result;
  const size_t count = in.count(kLeastTransform);
  for (size_t i = 0; i < count; ++i) {
    TransformMessage transform;
    transform.header = read_header(in);
    transform.child_frame = frame_name(in.text());
    const auto pose = read_pose(in);
    if (!pose || transform.child_frame.empty() || transform.child_frame == transform.header.frame) {
      ++result.refused;
      continue;
    }
    transform.T_parent_child = *pose;
    result.transforms.push_back(std::move(transform));
  }
  return result;
}

}  // namespace hmt::submap
