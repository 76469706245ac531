// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// How far the odometry of a log can be trusted: variances that grow with the motion,
///   var(x) = var(y) = r_t + a (distance + l |rotation|),   var(rotation) = r_r + b (|rotation| +
///   distance / 10 l)
/// (also z and tilt, in space). All four are learnt from the differences between odometry and
/// registration so far, starting from those of a poor wheeled robot; r from steps in which the
/// odometry stood still, so a log without odometry is one whose r is large.
class OdometryModel {
 public:
  explicit OdometryModel(Space space) : space_(space) {}

  /// Of a robot about which nothing tells but how it moved before.
  static OdometryModel of_unknown_motion(Space space);

  /// Covariance of an odometry step (tangent of Pose, frame of its end); rows of z, rx and ry are
  /// zero in the plane.
  Matrix6d covariance(const Pose& step) const;
  /// Learns from a step that registration measured well.
  void learn(const Pose& odometry_step, const Pose& measured_step);
  /// Whether a step may be a motion at all, not a jump of a broken or restarted odometry.
  static bool is_motion(const Pose& step);
  /// Whether the odometry stood still.
  static bool is_rest(const Pose& step);

 private:
  struct Rate {
    double squares;  // fading sum of squared errors
    double amount;   // fading sum of motion, or of steps
    double value() const { return squares / amount; }
    void add(double square, double more, double memory);
  };

  Space space_;
  Rate translation_{0.05, 5.0};
  Rate rotation_{0.05, 5.0};
  // At rest a robot may still shift by a millimetre and half a milliradian from step to step.
  Rate rest_translation_{1e-6 * 5, 5};
  Rate rest_rotation_{2.5e-7 * 5, 5};
};

}  // namespace hmt::submap
