// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "hmt/graph/pose.hpp"

namespace hmt::submap {

/// How far the uncertainty of T_a_b moves the points of b against those of a: the first factor of
/// [Blanco 2009, Eq. 16], as a function of the place in a common frame. A perturbation (t, r) of b
/// moves a point x by t + r x (x - origin of b), so its covariance is J Sigma J^T with
/// J = [I, -[x - origin]x]. The same function serves both directions of matching.
class PoseSpread {
 public:
  /// `covariance_a_b` in the tangent of Pose (frame b); throws InputError if it is not finite.
  PoseSpread(const graph::Pose& T_frame_b, const graph::Matrix6d& covariance_a_b);

  /// 3x3 covariance of the displacement at x, metres^2, in the common frame.
  Eigen::Matrix3d covariance(const Eigen::Vector3d& x) const;
  /// Its trace: the mean square displacement at x.
  double trace(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d d = x - origin_;
    return tt_trace_ + linear_.dot(d) + d.dot(quadratic_ * d);
  }
  /// Root mean square displacement anywhere within `radius_m` of x, at most: the root of the trace
  /// is a norm of a displacement that is linear in x, so the triangle inequality holds.
  double max_deviation(const Eigen::Vector3d& x, double radius_m) const {
    return std::sqrt(std::max(0.0, trace(x))) + radius_m * rotation_deviation_rad_;
  }

 private:
  Eigen::Vector3d origin_;
  Eigen::Matrix3d tt_;  ///< covariance of the translation, common frame
  Eigen::Matrix3d tr_;
  Eigen::Matrix3d rr_;
  // The trace is tt_trace + linear . d + d^T quadratic d.
  double tt_trace_ = 0;
  Eigen::Vector3d linear_;
  Eigen::Matrix3d quadratic_;
  double rotation_deviation_rad_ = 0;
};

}  // namespace hmt::submap
