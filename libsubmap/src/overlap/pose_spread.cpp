// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pose_spread.hpp"

#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

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
  rotation_deviation_rad_ = std::sqrt(std::max(0.0, rr_.trace()));
  // tr(tr_ [d]x) is linear in d.
  linear_ =
      2 * Eigen::Vector3d(tr_(1, 2) - tr_(2, 1), tr_(2, 0) - tr_(0, 2), tr_(0, 1) - tr_(1, 0));
}

Eigen::Matrix3d PoseSpread::covariance(const Eigen::Vector3d& x) const {
  const Eigen::Matrix3d d = skew(x - origin_);
  const Eigen::Matrix3d cross = tr_ * d;
  return tt_ + cross + cross.transpose() - d * rr_ * d;
}

}  // namespace hmt::submap
