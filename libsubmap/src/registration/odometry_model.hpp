// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// How far the odometry of a log can be trusted: variances that grow with the motion,
///   var(x) = var(y) = a (distance + l |rotation|),   var(rotation) = b (|rotation| + distance / l)
/// (also z and tilt, in space), a and b learnt from the differences between odometry and
/// registration so far, starting from those of a poor wheeled robot.
class OdometryModel {
 public:
  explicit OdometryModel(Space space) : space_(space) {}

  /// Covariance of an odometry step (tangent of Pose, frame of its end); rows of z, rx and ry are
  /// zero in the plane.
  Matrix6d covariance(const Pose& step) const;
  /// Learns from a step that registration measured well.
  void learn(const Pose& odometry_step, const Pose& measured_step);
  /// Whether a step may be a motion at all, not a jump of a broken or restarted odometry.
  static bool is_motion(const Pose& step);

 private:
  struct Rate {
    double squares;  // weighted sum of squared errors
    double motion;   // weighted sum of motion
    double value() const { return squares / motion; }
  };

  Space space_;
  Rate translation_{0.05, 5.0};
  Rate rotation_{0.05, 5.0};
};

}  // namespace hmt::submap
