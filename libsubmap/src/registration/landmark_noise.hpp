// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// Covariance of the position of a landmark (sensor frame) of which the log tells none: that of an
/// ordinary camera or laser. In the plane nothing varies along z.
Eigen::Matrix3d ordinary_covariance(Space space, const Eigen::Vector3d& position_sensor);

/// Which sightings of a landmark were made from one view: until the robot has moved by some
/// keyframes, what is wrong with one (its lighting, its direction in the lens) is wrong with the
/// others.
class LandmarkViews {
 public:
  explicit LandmarkViews(const TrackOptions& options) : options_(options) {}

  /// The view that the next sighting belongs to; every unnamed one is a view of its own.
  size_t add(int64_t name, const Pose& T_odom_robot);
  /// Sightings of that view so far.
  int size(size_t view) const { return sizes_[view]; }

 private:
  struct Latest {
    Pose T_odom_robot;
    size_t view;
  };
  TrackOptions options_;
  std::map<int64_t, Latest> latest_;  // by name
  std::vector<int> sizes_;            // by view
};

/// The observations with all covariances that the log does not tell filled in: those of an ordinary
/// camera or laser on an ordinary wheeled robot. Nothing finer is learnt from the log, because the
/// errors of a landmark's sightings are alike while the robot stays in one view, and a likelihood
/// that does not know this finds noise that is far too small; within a factor of two the map hardly
/// depends on these numbers.
///
/// For the same reason sightings of a named landmark from one view, until the robot has moved by
/// some keyframes, count as one: each gets the variance of one times their number.
///
/// Odometry in the plane of which the log does not tell the covariance is freed of what it does
/// wrong always, as a filter over the log and its named landmarks makes it out.
std::vector<Observation> with_noise(std::vector<Observation> observations, Space space,
                                    const TrackOptions& options);

}  // namespace hmt::submap
