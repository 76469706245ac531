// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "hmt/submap/observation/observation.hpp"
#include "markers_message.hpp"
#include "pose_history.hpp"

namespace hmt::submap {

/// The landmarks of one message.
struct LandmarkSight {
  int sensor = 0;
  int64_t stamp_ns = 0;     ///< by the clock of the odometry
  int64_t received_ns = 0;  ///< by the recorder's
  double own_stamp_s = 0;
  std::string place;  ///< in the log
  Pose T_robot_sensor;
  std::vector<Marker> markers;
};

/// Sights of landmarks on their way to become readings of the observation that is next to them in
/// time, to which the odometry carries them. In the plane they are seen from above.
class LandmarkSights {
 public:
  /// False where the oldest one had to go for it, because nothing took it.
  bool add(LandmarkSight sight);
  bool empty() const { return sights_.empty(); }
  size_t size() const { return sights_.size(); }
  const LandmarkSight& front() const { return sights_.front(); }
  LandmarkSight pop();

  struct Taken {
    std::vector<LandmarkReading> readings;  ///< by stamp, then sensor
    int64_t too_far = 0;                    ///< messages more than a second from any observation
    int64_t without_odometry = 0;
  };
  /// Takes those that are nearer to an observation than to the next one, if there is a next one.
  Taken take(const Pose& T_odom_robot, int64_t stamp_ns, std::optional<int64_t> next_stamp_ns,
             const PoseHistory& odometry, Space space);

 private:
  std::deque<LandmarkSight> sights_;  ///< in the order of the recording
};

/// What the sight is to a robot that stands at T_robot_then from where it stood then.
LandmarkReading as_reading(const LandmarkSight& sight, const Pose& T_robot_then, Space space);

}  // namespace hmt::submap
