// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>

#include "hmt/submap/observation/observation.hpp"
#include "odometry_calibration.hpp"

namespace hmt::submap {

/// A landmark as it was measured, in the frame of the robot.
struct MeasuredLandmark {
  Eigen::Vector3d p_robot = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// How a measurement agrees with where its landmark is expected.
struct Innovation {
  double mahalanobis_squared = 0;
  double log_determinant = 0;  ///< of the covariance of the innovation
};

/// Extended Kalman filter over the robot's pose, what its odometry does wrong always, and the
/// landmarks that were seen most recently, in the plane and in space alike. It forgets the landmark
/// that was not seen for the longest time when there are too many, so a step costs the same all
/// along a log; it drifts over long distances.
class LandmarkFilter {
 public:
  /// `deviation`: of the errors of odometry, of which nothing else is known at the start.
  LandmarkFilter(Space space, const Pose& T_track_robot,
                 const OdometryErrors& deviation = OdometryErrors::Zero());

  /// Covariance: tangent of Pose, frame of the end of the step.
  void predict(const Pose& T_before_now, const Matrix6d& covariance);
  /// The same for a step as odometry tells it, with the errors that the filter makes out.
  void predict_told(const Pose& told, double duration_s, const Matrix6d& covariance);
  /// Nothing for a landmark that the filter does not hold.
  std::optional<Innovation> innovation(int landmark, const MeasuredLandmark& measured) const;
  void update(int landmark, const MeasuredLandmark& measured);
  void insert(int landmark, const MeasuredLandmark& measured);
  void forget(int landmark);

  const Pose& T_track_robot() const { return T_track_robot_; }
  const OdometryErrors& odometry_errors() const { return errors_; }
  /// The landmarks that it holds: number to slot.
  const std::map<int, int>& landmarks() const { return slot_of_; }

 private:
  static constexpr int kPose = 6;
  static constexpr int kErrors = OdometryErrors::SizeAtCompileTime;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;

  struct Prediction {
    Eigen::Vector3d p_robot;
    Eigen::Matrix<double, 3, 6> J_pose;
    Eigen::Matrix3d J_point;
  };

  static int row_of(int slot) { return kPose + kErrors + 3 * slot; }
  Prediction predict_measurement(int slot) const;
  Eigen::Matrix3d innovation_covariance(int slot, const Prediction& predicted,
                                        const Eigen::Matrix3d& measured) const;
  int free_slot();

  int rows_;  ///< of a measurement: 2 in the plane, 3 in space
  Pose T_track_robot_;
  OdometryErrors errors_ = OdometryErrors::Zero();
  std::vector<Eigen::Vector3d> p_track_;  ///< by slot
  std::vector<int64_t> last_seen_;        ///< by slot, in calls
  std::map<int, int> slot_of_;
  int64_t calls_ = 0;
  /// Of the pose (tangent, frame of the robot), of the errors of odometry, of the landmarks in
  /// their slots.
  Rows covariance_;
};

}  // namespace hmt::submap
