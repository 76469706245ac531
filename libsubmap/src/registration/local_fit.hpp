// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace hmt::submap {

/// Line (in the plane z = 0) or plane through a few neighboring points, by total least squares.
struct LocalFit {
  int points = 0;
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, either side
  double residual2 = 0;  ///< sum of squared distances along the normal, m^2
  double spread2 = 0;    ///< sum of squared distances along the narrowest direction of the
                         ///< surface, m^2: what holds the normal's direction
};

/// Running sums over the neighbors of a point; coordinates are taken relative to it so that no
/// digits are lost far from the origin.
class LocalFitSums {
 public:
  void add(const Eigen::Vector3d& p) {
    ++points_;
    sum_ += p;
    squares_ += p * p.transpose();
  }
  int points() const { return points_; }
  LocalFit line() const;   ///< at least 2 points with z = 0
  LocalFit plane() const;  ///< at least 3 points

 private:
  int points_ = 0;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();
};

}  // namespace hmt::submap
