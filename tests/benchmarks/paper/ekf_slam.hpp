// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace hmt::paper {

/// What a planar sensor measures of one landmark, in its own frame; the landmark is known by its
/// number.
struct RangeBearing {
  int landmark = 0;
  double range_m = 0;
  double bearing_rad = 0;
};

/// A plain extended Kalman filter on the robot's pose (x, y, yaw) and point landmarks (x, y) in the
/// plane [Dissanayake 2001], the kind of filter that [Blanco 2009, Sec. 6.1] takes its information
/// matrix from. The start pose is the origin, known exactly.
class EkfSlam {
 public:
  /// Standard deviations of a measurement, > 0.
  EkfSlam(double sigma_range_m, double sigma_bearing_rad);

  /// The robot moves by (x, y, yaw) in its own frame, with that covariance.
  void predict(const Eigen::Vector3d& motion, const Eigen::Matrix3d& covariance);
  /// Landmarks that were not seen before join the state.
  void update(std::span<const RangeBearing> seen);

  Eigen::Vector3d pose() const { return mean_.head<3>(); }
  /// Pose and landmarks.
  const Eigen::VectorXd& mean() const { return mean_; }
  /// The landmarks of the state, in the order of rows 3, 5, 7, ... of the covariance.
  const std::vector<int>& landmarks() const { return landmarks_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }

 private:
  void add(const RangeBearing& z);
  void correct(const RangeBearing& z, Eigen::Index row);

  Eigen::Matrix2d noise_;
  Eigen::VectorXd mean_ = Eigen::VectorXd::Zero(3);
  Eigen::MatrixXd covariance_ = Eigen::MatrixXd::Zero(3, 3);
  std::vector<int> landmarks_;
};

}  // namespace hmt::paper
