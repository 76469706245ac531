// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pose_spread.hpp"

#include <cmath>

#include "hmt/graph/input_error.hpp"

namespace hmt::submap {

PoseSpread::PoseSpread(const graph::Pose& T_frame_b, const graph::Matrix6d& covariance_a_b)
    : origin_(T_frame_b.translation) {
  if (!covariance_a_b.allFinite()) {
    throw graph::InputError("overlap: the covariance of a relative pose is not finite");
  }
  const Eigen::Matrix3d R = T_frame_b.rotation_matrix();
  tt_ = R * covariance_a_b.topLeftCorner<3, 3>() * R.transpose();
  tr_ = R * covariance_a_b.topRightCorner<3, 3>() * R.transpose();
  rr_ = R * covariance_a_b.bottomRightCorner<3, 3>() * R.transpose();
  tt_trace_ = tt_.trace();
  quadratic_ = rr_.trace() * Eigen::Matrix3d::Identity() - rr_;
  // tr(tr_ [d]x) is linear in d.
  linear_ =
      2 * Eigen::Vector3d(tr_(1, 2) - tr_(2, 1), tr_(2, 0) - tr_(0, 2), tr_(0, 1) - tr_(1, 0));
  origin_f_ = origin_.cast<float>();
  linear_f_ = linear_.cast<float>();
  quadratic_f_ = quadratic_.cast<float>();
  tt_trace_f_ = static_cast<float>(tt_trace_);
  rr_trace_f_ = static_cast<float>(rr_.trace());
  floor_ = least_covariance();
}

PoseSpread::Floor PoseSpread::least_covariance() const {
  // Covariance of the translation once the rotation is known. A little is added to the rotation's
  // so that it can be inverted in the plane, too; what that adds to a displacement at any place of
  // a map is far below kSlack_m2.
  constexpr double kLeast_rad2 = 1e-12, kSlack_m2 = 1e-7;
  const Eigen::Matrix3d known = rr_ + kLeast_rad2 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d C = tt_ - tr_ * known.inverse() * tr_.transpose();
  // The smaller eigenvalue of the block of x and y, less the norm of what ties it to z.
  const double mean = (C(0, 0) + C(1, 1)) / 2;
  const double smaller = mean - std::hypot((C(0, 0) - C(1, 1)) / 2, C(0, 1));
  const double slack = std::hypot(C(0, 2), C(1, 2)) + kSlack_m2;
  // Written so that what is not a number becomes zero.
  const auto positive = [](double v) { return v > 0 ? v : 0.0; };
  return {positive(smaller - slack), positive(C(2, 2) - slack)};
}

Eigen::Matrix3d PoseSpread::covariance(const Eigen::Vector3d& x) const {
  const Eigen::Matrix3d d = graph::skew(x - origin_);
  const Eigen::Matrix3d cross = tr_ * d;
  return tt_ + cross + cross.transpose() - d * rr_ * d;
}

}  // namespace hmt::submap
