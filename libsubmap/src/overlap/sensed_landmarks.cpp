// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sensed_landmarks.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace hmt::submap {
namespace {

// Positions are not taken to be known better than to a tenth of a millimetre, which is below any
// sensor and above the rounding of poses. Exact and planar landmarks (no variance along z) so obey
// the same formula: differences along z are zero and count for nothing.
constexpr double kLeastSigma_m = 1e-4;
// Negative eigenvalues of a covariance by rounding, against the largest.
constexpr double kRounding = 1e-9;

/// The largest eigenvalue; throws where the matrix is no covariance.
double largest_variance(const Eigen::Matrix3d& covariance, int sensor, size_t landmark) {
  const std::string name =
      "overlap: landmark " + std::to_string(landmark) + " of sensor " + std::to_string(sensor);
  if (!covariance.allFinite()) throw InputError(name + ": its covariance is not finite");
  const Eigen::Vector3d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
          .eigenvalues();
  if (eigenvalues[0] < -kRounding * std::max(eigenvalues[2], 0.0)) {
    throw InputError(name + ": its covariance has the eigenvalue " +
                     std::to_string(eigenvalues[0]) + ", must be positive semidefinite");
  }
  return eigenvalues[2];
}

}  // namespace

double descriptor_distance(std::span<const float> a, std::span<const float> b) {
  const auto size = static_cast<Eigen::Index>(a.size());
  return static_cast<double>((Eigen::Map<const Eigen::VectorXf>(a.data(), size) -
                              Eigen::Map<const Eigen::VectorXf>(b.data(), size))
                                 .norm());
}

SensedLandmarks::SensedLandmarks(const LandmarkReading& reading, const Pose& T_frame_robot,
                                 const OverlapOptions& options) {
  const Pose T_frame_sensor = T_frame_robot * reading.T_robot_sensor;
  const Eigen::Matrix3d R = T_frame_sensor.rotation_matrix();
  const double least = kLeastSigma_m * kLeastSigma_m;
  const double square_distance = options.max_mahalanobis * options.max_mahalanobis;
  for (size_t i = 0; i < reading.landmarks.size(); ++i) {
    const Landmark& landmark = reading.landmarks[i];
    const double variance = largest_variance(landmark.covariance_sensor, reading.sensor, i);
    if (!landmark.position_sensor.allFinite()) continue;
    SensedLandmark sensed;
    sensed.id = landmark.id;
    sensed.position = T_frame_sensor * landmark.position_sensor;
    sensed.covariance = R * landmark.covariance_sensor * R.transpose();
    sensed.covariance.diagonal().array() += least;
    sensed.gate = square_distance * (variance + least);
    sensed.descriptor = landmark.descriptor;
    max_gate_ = std::max(max_gate_, sensed.gate);
    landmarks_.push_back(std::move(sensed));
  }
  for (int i = 0; i < size(); ++i) {
    by_x_.push_back(i);
    if ((*this)[i].id != kUnknownLandmark) by_name_.push_back(i);
  }
  std::stable_sort(by_x_.begin(), by_x_.end(), [this](int i, int j) {
    return (*this)[i].position.x() < (*this)[j].position.x();
  });
  std::stable_sort(by_name_.begin(), by_name_.end(),
                   [this](int i, int j) { return (*this)[i].id < (*this)[j].id; });
  limit_pose_deviation(options);
  measure_descriptors();
}

void SensedLandmarks::limit_pose_deviation(const OverlapOptions& options) {
  for (int i = 0; i < size(); ++i) {
    SensedLandmark& landmark = landmarks_[static_cast<size_t>(i)];
    landmark.max_pose_deviation_m = options.max_pose_deviation_m;
    if (size() < 2) continue;
    double spacing = std::numeric_limits<double>::infinity();
    for (int j = 0; j < size(); ++j) {
      if (j != i) spacing = std::min(spacing, (landmark.position - (*this)[j].position).norm());
    }
    landmark.max_pose_deviation_m =
        std::max(landmark.max_pose_deviation_m, spacing / (2 * options.max_mahalanobis));
  }
}

void SensedLandmarks::measure_descriptors() {
  std::vector<double> distances;
  for (int i = 0; i < size(); ++i) {
    for (int j = 0; j < i; ++j) {
      const auto &a = (*this)[i].descriptor, &b = (*this)[j].descriptor;
      if (a.empty() || a.size() != b.size()) continue;
      const double distance = descriptor_distance(a, b);
      if (std::isfinite(distance)) distances.push_back(distance);
    }
  }
  if (distances.empty()) return;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  descriptor_gate_ = *middle / 2;
}

}  // namespace hmt::submap
