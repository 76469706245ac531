// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "hmt/submap/overlap/overlap.hpp"

namespace hmt::submap {

/// A landmark of a reading in the frame that two readings are compared in.
struct SensedLandmark {
  int64_t id = kUnknownLandmark;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of the measurement, common frame, m^2
  /// d^2 * the largest eigenvalue of the covariance, metres^2; d is the largest Mahalanobis
  /// distance of a correspondence.
  double gate = 0;
  /// A landmark without a name matches nothing where the pose alone moves it by more (root mean
  /// square): the gate of d deviations would reach more than half way to the next landmark.
  double max_pose_deviation_m = 0;
  std::vector<float> descriptor;
};

/// The landmarks of a reading, prepared for matching.
class SensedLandmarks {
 public:
  /// Landmarks at positions that are not finite are left out. Throws InputError naming the landmark
  /// whose covariance is not finite or not positive semidefinite.
  SensedLandmarks(const LandmarkReading& reading, const Pose& T_frame_robot,
                  const OverlapOptions& options);

  int size() const { return static_cast<int>(landmarks_.size()); }
  std::span<const SensedLandmark> landmarks() const { return landmarks_; }
  const SensedLandmark& operator[](int i) const { return landmarks_[static_cast<size_t>(i)]; }
  /// Those that the log names, by id and index.
  std::span<const int> by_name() const { return by_name_; }
  /// All of them, by x and index.
  std::span<const int> by_x() const { return by_x_; }
  double max_gate() const { return max_gate_; }
  /// Descriptors farther apart than this are of two landmarks: half of what is usual (the median)
  /// between landmarks of this reading, which are two for certain. Infinite where there are no two
  /// descriptors of equal length.
  double descriptor_gate() const { return descriptor_gate_; }

 private:
  void limit_pose_deviation(const OverlapOptions& options);
  void measure_descriptors();

  std::vector<SensedLandmark> landmarks_;
  std::vector<int> by_name_;
  std::vector<int> by_x_;
  double max_gate_ = 0;
  double descriptor_gate_ = std::numeric_limits<double>::infinity();
};

/// Euclidean distance of two descriptors of equal length.
double descriptor_distance(std::span<const float> a, std::span<const float> b);

}  // namespace hmt::submap
