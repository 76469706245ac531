// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "messages.hpp"

namespace hmt::submap {

/// A marker or an object that has a name and stands at a place. How it is turned is not read.
struct Marker {
  int64_t name = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< frame of the message's header, metres
  /// Of the position, m^2; zero where the message does not tell it.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// What was seen at one time.
struct MarkersMessage {
  MessageHeader header;
  std::vector<Marker> markers;
  int64_t refused = 0;  ///< whose position or covariance is none
  int64_t unnamed = 0;  ///< without a name that is one number, as bundles of tags are
};

/// A message of any kind for which is_landmark_data() holds.
MarkersMessage read_markers(WireReader in, MessageKind kind);

}  // namespace hmt::submap
