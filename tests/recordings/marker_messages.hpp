// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "wire_writer.hpp"

namespace hmt::test {

/// A marker as a camera sees it, in the frame of the camera.
struct SampleMarker {
  int64_t name = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

inline void pose_with_covariance(WireWriter& out, const SampleMarker& marker) {
  out.pose({marker.position, Eigen::Quaterniond::Identity()});
  for (Eigen::Index row = 0; row < 6; ++row)
    for (Eigen::Index column = 0; column < 6; ++column)
      out.number(row < 3 && column < 3 ? marker.covariance(row, column) : 0.0);
}

/// apriltag_ros/AprilTagDetectionArray.
inline std::string april_tags(WireWriter out, int64_t stamp_ns, std::string_view frame,
                              const std::vector<SampleMarker>& markers) {
  out.header(stamp_ns, frame).number(static_cast<uint32_t>(markers.size()));
  for (const SampleMarker& marker : markers) {
    out.number(uint32_t{1}).number(static_cast<int32_t>(marker.name));
    out.number(uint32_t{1}).number(0.2);  // size
    out.header(stamp_ns, frame);
    pose_with_covariance(out, marker);
  }
  return out.bytes();
}

/// ros2_aruco_interfaces/ArucoMarkers.
inline std::string aruco_markers(WireWriter out, int64_t stamp_ns, std::string_view frame,
                                 const std::vector<SampleMarker>& markers) {
  out.header(stamp_ns, frame).number(static_cast<uint32_t>(markers.size()));
  for (const SampleMarker& marker : markers) out.number(marker.name);
  out.number(static_cast<uint32_t>(markers.size()));
  for (const SampleMarker& marker : markers)
    out.pose({marker.position, Eigen::Quaterniond::Identity()});
  return out.bytes();
}

/// aruco_opencv_msgs/ArucoDetection without boards.
inline std::string aruco_detection(WireWriter out, int64_t stamp_ns, std::string_view frame,
                                   const std::vector<SampleMarker>& markers) {
  out.header(stamp_ns, frame).number(static_cast<uint32_t>(markers.size()));
  for (const SampleMarker& marker : markers)
    out.number(static_cast<uint16_t>(marker.name))
        .pose({marker.position, Eigen::Quaterniond::Identity()});
  return out.number(uint32_t{0}).bytes();
}

/// vision_msgs/Detection3DArray of ROS 2, with two hypotheses of which the second is more likely.
inline std::string detections(WireWriter out, int64_t stamp_ns, std::string_view frame,
                              const std::vector<SampleMarker>& markers) {
  out.header(stamp_ns, frame).number(static_cast<uint32_t>(markers.size()));
  for (const SampleMarker& marker : markers) {
    out.header(stamp_ns, frame).number(uint32_t{2});
    out.text("dustbin").number(0.1);
    pose_with_covariance(out, {});
    out.text("tag").number(0.9);
    pose_with_covariance(out, marker);
    out.pose({}).number(1.0).number(1.0).number(1.0);  // bounding box
    out.text(std::to_string(marker.name));
  }
  return out.bytes();
}

}  // namespace hmt::test
