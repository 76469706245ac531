// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "local_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hmt::submap {

LocalFit LocalFitSums::line() const {
  const double n = points_;
  const Eigen::Vector3d mean = sum_ / n;
  const Eigen::Matrix3d scatter = squares_ - n * mean * mean.transpose();
  const double half_trace = (scatter(0, 0) + scatter(1, 1)) / 2;
  const double half_difference = (scatter(0, 0) - scatter(1, 1)) / 2;
  const double root = std::hypot(half_difference, scatter(0, 1));
  const double along_rad = std::atan2(scatter(0, 1), half_difference) / 2;
  return {.points = points_,
          .centroid = mean,
          .normal = {-std::sin(along_rad), std::cos(along_rad), 0},
          .residual2 = std::max(0.0, half_trace - root),
          .spread2 = half_trace + root};
}

LocalFit LocalFitSums::plane() const {
  const double n = points_;
  const Eigen::Vector3d mean = sum_ / n;
  const Eigen::Matrix3d scatter = squares_ - n * mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  return {.points = points_,
          .centroid = mean,
          .normal = eigen.eigenvectors().col(0),
          .residual2 = std::max(0.0, eigen.eigenvalues()[0]),
          .spread2 = std::max(0.0, eigen.eigenvalues()[1])};
}

}  // namespace hmt::submap
