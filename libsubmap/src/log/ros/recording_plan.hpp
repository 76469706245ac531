// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "../recording/recording.hpp"
#include "transform_tree.hpp"

namespace hmt::submap {

/// What of a recording a map is made of.
struct RecordingPlan {
  std::vector<std::string> scan_topics;  ///< sensor k is that of topic k; empty: only landmarks
  /// Topics of landmarks that the user named; empty: each that carries markers.
  std::vector<std::string> landmark_topics;
  std::string odometry_topic;  ///< of nav_msgs/Odometry; empty: the odometry is in /tf
  bool has_odometry = true;    ///< false: the scans alone tell how the robot moves
  std::string odom_frame;      ///< with odometry in /tf: the parent of robot_frame
  std::string robot_frame;
  std::string imu_topic;     ///< the only one; empty if there is none, or several
  Space space = Space::se2;  ///< se3 as soon as one topic has clouds
  /// The clocks of scans and odometry differ, so both are taken at the time of receipt.
  bool uses_time_of_receipt = false;
  /// All transforms of the first part of the recording.
  TransformTree transforms;
};

/// Reads a recording until 200 scans and some odometry were seen, 64 MB at least, and chooses the
/// topics: those that `options` names, otherwise the only one of its kind, and without scans
/// landmarks. Throws InputError listing the topics where there is none or the choice is not
/// obvious.
RecordingPlan plan_recording(const std::filesystem::path& path, const LogOptions& options);

/// Whether landmarks are read from a topic of such messages.
bool takes_landmarks(const std::string& topic, MessageKind kind,
                     const std::vector<std::string>& chosen);

}  // namespace hmt::submap
