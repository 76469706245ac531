// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// How far the odometry of a log can be trusted: variances that grow with the motion,
///   var(x) = var(y) = r_t + a (distance + l |rotation|),   var(rotation) = r_r + b (|rotation| +
///   distance / 10 l).
/// All four are learnt from the differences between odometry and registration so far, starting from
/// those of a poor wheeled robot; r from steps in which the odometry stood still, so a log without
/// odometry is one whose r is large. In space the three axes of each are learnt one by one: what
/// slips along the way may be held upright by an inertial sensor.
class OdometryModel {
 public:
  explicit OdometryModel(Space space) : space_(space) {}

  /// Of a robot about which nothing tells but how it moved before.
  static OdometryModel of_unknown_motion(Space space);

  /// Covariance of an odometry step (tangent of Pose, frame of its end); rows of z, rx and ry are
  /// zero in the plane.
  Matrix6d covariance(const Pose& step) const;
  /// Learns from a step that registration measured. `noise`: variances of the measurement, which
  /// are taken out of the squared differences; an axis counts the less the noisier it is.
  void learn(const Pose& odometry_step, const Pose& measured_step, const Vector6d& noise);
  /// What the variances of the six directions grow with in a step.
  static Vector6d motion_by_axis(const Pose& step);
  /// Whether a step may be a motion at all, not a jump of a broken or restarted odometry.
  static bool is_motion(const Pose& step);
  /// Whether the odometry stood still.
  static bool is_rest(const Pose& step);

 private:
  struct Rate {
    double squares;   // fading sum of squared errors
    double amount;    // fading sum of motion, or of steps
    double seen = 0;  // the same without fading
    double value() const { return std::max(squares / amount, kLeastRate); }
    void add(double square, double more, double memory, double weight);
  };
  /// A tenth of a millimetre, or of a milliradian, in a metre: nothing measures a way better.
  static constexpr double kLeastRate = 1e-8;
  using Rates = std::array<Rate, 6>;
  static Rates all(Rate translation, Rate rotation) {
    return {translation, translation, translation, rotation, rotation, rotation};
  }

  Space space_;
  Rates moving_ = all({0.05, 5.0}, {0.05, 5.0});
  // At rest a robot may still shift by a millimetre and half a milliradian from step to step.
  Rates rest_ = all({1e-6 * 5, 5}, {2.5e-7 * 5, 5});
};

}  // namespace hmt::submap
