// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>

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
  /// Variances in the plane of x and y and along z that the covariance has in every direction of
  /// them, at every place, at least: those that are left when the rotation is known. Any covariance
  /// minus diag(plane, plane, height) is positive semidefinite.
  struct Floor {
    double plane = 0;
    double height = 0;
    /// The two smaller eigenvalues of any covariance are at least as large, together, so the
    /// largest is at most the trace less this.
    double smaller_two() const { return plane + std::min(plane, height); }
  };
  const Floor& floor() const { return floor_; }
  /// Mean square displacement anywhere within `radius_m` of x, at most. The root of the trace is a
  /// norm of a displacement that is linear in x, so it grows by no more than radius_m times the
  /// deviation of the rotation; and (a + b)^2 <= (1 + t) a^2 + (1 + 1/t) b^2 for any t > 0. Quick,
  /// for it is asked most often.
  float max_trace(const Eigen::Vector3f& x, float radius_m) const {
    constexpr float t = 0.05F;
    const Eigen::Vector3f d = x - origin_f_;
    const float trace = tt_trace_f_ + linear_f_.dot(d) + d.dot(quadratic_f_ * d);
    return (1 + t) * trace + (1 + 1 / t) * radius_m * radius_m * rr_trace_f_;
  }

 private:
  Floor least_covariance() const;

  Eigen::Vector3d origin_;
  Eigen::Matrix3d tt_;  ///< covariance of the translation, common frame
  Eigen::Matrix3d tr_;
  Eigen::Matrix3d rr_;
  // The trace is tt_trace + linear . d + d^T quadratic d.
  double tt_trace_ = 0;
  Eigen::Vector3d linear_;
  Eigen::Matrix3d quadratic_;
  // The same in float.
  Eigen::Vector3f origin_f_, linear_f_;
  Eigen::Matrix3f quadratic_f_;
  float tt_trace_f_ = 0, rr_trace_f_ = 0;
  Floor floor_;
};

}  // namespace hmt::submap
