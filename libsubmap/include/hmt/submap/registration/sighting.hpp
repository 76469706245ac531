// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// A landmark of the map as one observation saw it, carried to its keyframe.
struct Sighting {
  int64_t observation = 0;  ///< its index in the log
  int place = 0;            ///< among the landmarks of that observation, reading after reading
  int keyframe = 0;         ///< that the observation hangs on
  int landmark = 0;         ///< number of the landmark in the map, 0..
  Eigen::Vector3d p_keyframe = Eigen::Vector3d::Zero();  ///< frame of the keyframe, metres
  /// Inverse covariance of p_keyframe: of the measurement, and of the odometry since the keyframe.
  /// In Space::se2 only x and y are used.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();

  bool operator==(const Sighting&) const = default;
};

/// A landmark at its place.
struct PlacedLandmark {
  int landmark = 0;                                      ///< its number in the map
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    ///< metres
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the position, m^2

  bool operator==(const PlacedLandmark&) const = default;
};

}  // namespace hmt::submap
