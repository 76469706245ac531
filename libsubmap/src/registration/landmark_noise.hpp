// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include "hmt/submap/registration/track.hpp"
#include "landmark_filter.hpp"

namespace hmt::submap {

/// Noise of the sensors of a log that does not tell it. As logarithms, over which it is searched.
struct LandmarkNoise {
  /// Deviations: of the range at no distance, metres; of the range, per metre; of the bearing,
  /// radians; of odometry, metres per square root of a metre; of its heading, radians per square
  /// root of a radian. The start is a poor sensor on a poor robot.
  std::array<double, 5> log_deviation = {-2.3, -3.0, -3.0, -1.6, -1.6};
  /// True by odometry's motion: of distances, of turns. Wheels and gyroscopes are never quite as
  /// large or as quick as a robot takes them to be.
  std::array<double, 2> log_scale = {0, 0};

  /// A step as the robot made it.
  Pose calibrated(const Pose& T_before_now) const;

  /// Of a measured position: along the line of sight and across it.
  Eigen::Matrix3d of_landmark(Space space, const Eigen::Vector3d& position_sensor) const;
  /// Of an odometry step (tangent of Pose, frame of its end).
  Matrix6d of_motion(Space space, const Pose& T_before_now) const;
};

/// The observations with all covariances that the log does not tell filled in by maximum
/// likelihood, and with the odometry of which it does not tell them calibrated: the noise and the
/// scales under which the innovations of a filter that runs over the log are most probable. Where
/// nothing is missing nothing is done. A false measurement may lie anywhere in view, so it cannot
/// pull the result far.
///
/// What is wrong in a measurement is wrong in the next one from the same view, too: sightings of a
/// landmark count as one until the robot has moved by a few keyframes. Only the first of
/// them is learnt from, and each gets the variance of one times their number.
std::vector<Observation> with_noise(std::vector<Observation> observations, Space space,
                                    const TrackOptions& options, LandmarkNoise& noise);

}  // namespace hmt::submap
