// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ekf_slam.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace hmt::paper {
namespace {

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * std::numbers::pi);
}

}  // namespace

EkfSlam::EkfSlam(double sigma_range_m, double sigma_bearing_rad)
    : noise_(Eigen::Vector2d(sigma_range_m * sigma_range_m, sigma_bearing_rad * sigma_bearing_rad)
                 .asDiagonal()) {}

void EkfSlam::predict(const Eigen::Vector3d& motion, const Eigen::Matrix3d& covariance) {
  const double c = std::cos(mean_[2]);
  const double s = std::sin(mean_[2]);
  Eigen::Matrix3d by_motion;
  by_motion << c, -s, 0, s, c, 0, 0, 0, 1;
  const Eigen::Vector3d step = by_motion * motion;
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity();
  by_pose(0, 2) = -step.y();
  by_pose(1, 2) = step.x();
  mean_.head<3>() += step;
  mean_[2] = wrapped(mean_[2]);
  covariance_.topRows<3>() = (by_pose * covariance_.topRows<3>()).eval();
  covariance_.leftCols<3>() = (covariance_.leftCols<3>() * by_pose.transpose()).eval();
  covariance_.topLeftCorner<3, 3>() += by_motion * covariance * by_motion.transpose();
}

void EkfSlam::update(std::span<const RangeBearing> seen) {
  for (const RangeBearing& z : seen) {
    const auto known = std::find(landmarks_.begin(), landmarks_.end(), z.landmark);
    if (known == landmarks_.end())
      add(z);
    else
      correct(z, 3 + 2 * (known - landmarks_.begin()));
  }
}

void EkfSlam::add(const RangeBearing& z) {
  const double heading = mean_[2] + z.bearing_rad;
  const double c = std::cos(heading);
  const double s = std::sin(heading);
  Eigen::Matrix<double, 2, 3> by_pose;
  by_pose << 1, 0, -z.range_m * s, 0, 1, z.range_m * c;
  Eigen::Matrix2d by_measurement;
  by_measurement << c, -z.range_m * s, s, z.range_m * c;
  const Eigen::Index n = mean_.size();
  mean_.conservativeResize(n + 2);
  mean_.tail<2>() = mean_.head<2>() + z.range_m * Eigen::Vector2d(c, s);
  const Eigen::MatrixXd cross = by_pose * covariance_.topRows<3>();
  const Eigen::Matrix2d own = cross.leftCols<3>() * by_pose.transpose() +
                              by_measurement * noise_ * by_measurement.transpose();
  covariance_.conservativeResize(n + 2, n + 2);
  covariance_.bottomLeftCorner(2, n) = cross;
  covariance_.topRightCorner(n, 2) = cross.transpose();
  covariance_.bottomRightCorner<2, 2>() = own;
  landmarks_.push_back(z.landmark);
}

void EkfSlam::correct(const RangeBearing& z, Eigen::Index row) {
  const Eigen::Vector2d d = mean_.segment<2>(row) - mean_.head<2>();
  const double r = d.norm();
  Eigen::Matrix2d by_landmark;
  by_landmark << d.x() / r, d.y() / r, -d.y() / (r * r), d.x() / (r * r);
  Eigen::Matrix<double, 2, 3> by_pose;
  by_pose << -by_landmark, Eigen::Vector2d(0, -1);
  const Eigen::MatrixXd PHt = covariance_.leftCols<3>() * by_pose.transpose() +
                              covariance_.middleCols<2>(row) * by_landmark.transpose();
  const Eigen::Matrix2d S =
      by_pose * PHt.topRows<3>() + by_landmark * PHt.middleRows<2>(row) + noise_;
  const Eigen::MatrixXd gain = PHt * S.inverse();
  const Eigen::Vector2d residual(z.range_m - r,
                                 wrapped(z.bearing_rad - std::atan2(d.y(), d.x()) + mean_[2]));
  mean_ += gain * residual;
  mean_[2] = wrapped(mean_[2]);
  covariance_ -= gain * PHt.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

}  // namespace hmt::paper
