// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "hmt/graph/input_error.hpp"
#include "hmt/graph/pose.hpp"

namespace hmt::submap {

using graph::InputError;
using graph::Matrix6d;
using graph::Pose;
using graph::Space;
using graph::Vector6d;

/// Identity of a landmark that the log does not name.
inline constexpr int64_t kUnknownLandmark = -1;

/// What one range sensor saw at one stamp: a planar scan (z = 0 in the sensor frame) or a cloud.
struct Reading {
  int sensor = 0;  ///< which sensor of the log, 0..
  Pose T_robot_sensor;
  double max_range_m = 0;    ///< nothing is known beyond it
  double beam_step_rad = 0;  ///< angle between neighbouring beams: beta of Eq. 16
  /// Measured points in the sensor frame, metres, in beam order.
  std::vector<Eigen::Vector3f> points_sensor;
  /// Unit directions of the beams that met nothing up to max_range_m, in the sensor frame.
  std::vector<Eigen::Vector3f> misses_sensor;

  bool operator==(const Reading&) const = default;
};

/// A point feature that one sensor saw.
struct Landmark {
  /// Identity that the log gives it, 0..; kUnknownLandmark where the log gives none.
  int64_t id = kUnknownLandmark;
  Eigen::Vector3d position_sensor = Eigen::Vector3d::Zero();  ///< sensor frame, metres
  /// Of the position, m^2; zero where the log does not tell it, which the front end then learns.
  Eigen::Matrix3d covariance_sensor = Eigen::Matrix3d::Zero();
  std::vector<float> descriptor;  ///< of its appearance; empty if there is none

  bool operator==(const Landmark&) const = default;
};

/// The landmarks that one sensor saw at one stamp. Of a planar sensor z is 0, with variance 0.
struct LandmarkReading {
  int sensor = 0;  ///< which sensor of the log, 0..; range sensors are counted with them
  Pose T_robot_sensor;
  std::vector<Landmark> landmarks;

  bool operator==(const LandmarkReading&) const = default;
};

/// What all sensors saw at one stamp.
struct Observation {
  int64_t index = 0;   ///< position in the log, 0..
  double stamp_s = 0;  ///< the log's own stamp, as it was
  Pose T_odom_robot;   ///< by the log's odometry at the stamp
  /// Of the odometry's motion since the observation before (tangent of Pose, frame of this one);
  /// nothing where the log does not tell it.
  std::optional<Matrix6d> motion_covariance;
  std::vector<Reading> readings;                   ///< of range sensors
  std::vector<LandmarkReading> landmark_readings;  ///< of sensors of landmarks

  bool operator==(const Observation&) const = default;
};

/// Whether a reading is a cloud: any of its points lies off the plane z = 0 of the sensor.
bool is_cloud(const Reading& reading);

/// All measured points in the robot frame, readings one after the other.
std::vector<Eigen::Vector3d> points_in_robot(const Observation& observation);

}  // namespace hmt::submap
