// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "information.hpp"

namespace hmt::submap {
namespace {

// Covariance of a step about which odometry says nothing: people walk, robots drive this far
// between two scans.
constexpr double kUnknownStep_m = 1.0;
constexpr double kUnknownStep_rad = 0.5;
// A pose that defines the map has no error against it.
constexpr double kDefining = 1e12;

Matrix6d diagonal_in(Space space, double translation, double rotation) {
  Vector6d v;
  v << translation, translation, translation, rotation, rotation, rotation;
  if (space == Space::se2) v.segment<3>(2).setZero();
  return v.asDiagonal();
}

double rotation_angle_rad(const Pose& T) {
  return 2 * std::atan2(T.rotation.vec().norm(), std::abs(T.rotation.w()));
}

}  // namespace

Tracker::Tracker(Space space, const TrackOptions& options)
    : space_(space), options_(options), odometry_(space) {
  track_.space = space;
}

void Tracker::start(const Observation& observation) {
  T_track_latest_ = observation.T_odom_robot;
  add_keyframe(observation, {T_track_latest_, diagonal_in(space_, kDefining, kDefining), true},
               make_surface(observation));
}

void Tracker::add(const Observation& observation) {
  if (track_.keyframes.empty()) {
    start(observation);
  } else {
    Pose step = relative_pose(T_odom_latest_, observation.T_odom_robot);
    Matrix6d step_covariance = odometry_.covariance(step);
    if (!OdometryModel::is_motion(step)) {
      step = Pose{};
      step_covariance =
          diagonal_in(space_, kUnknownStep_m * kUnknownStep_m, kUnknownStep_rad * kUnknownStep_rad);
      odometry_unbroken_ = false;
      ++counts_.odometry_jumps;
    }
    T_keyframe_odometry_ = T_keyframe_odometry_ * step;
    covariance_since_keyframe_ =
        compose_covariance(step, covariance_since_keyframe_, step_covariance);
    const Matrix6d covariance = compose_covariance(step, covariance_latest_, step_covariance);
    Surface surface = make_surface(observation);
    const Estimate found = estimate(surface, T_track_latest_ * step, covariance);
    T_track_latest_ = found.T_track_robot;
    covariance_latest_ =
        found.registered ? inverse_in(space_, inverse_in(space_, covariance) + found.information)
                         : covariance;
    const Pose T_keyframe_robot =
        relative_pose(track_.keyframes.back().T_track_robot, T_track_latest_);
    if (T_keyframe_robot.translation.norm() >= options_.keyframe_distance_m ||
        rotation_angle_rad(T_keyframe_robot) >= options_.keyframe_angle_rad)
      add_keyframe(observation, found, std::move(surface));
  }
  T_odom_latest_ = observation.T_odom_robot;
  const Keyframe& keyframe = track_.keyframes.back();
  track_.observations.push_back({observation.index, observation.stamp_s, keyframe.id,
                                 relative_pose(keyframe.T_track_robot, T_track_latest_)});
}

bool Tracker::is_trusted(const Registration& registration, const Pose& T_track_guess,
                         const Matrix6d& covariance) const {
  constexpr double kLeastInlierFraction = 0.5;
  constexpr double kLargestMahalanobis2 = 25;
  if (registration.termination == Registration::Termination::too_few_points) return false;
  if (registration.inlier_fraction < kLeastInlierFraction) return false;
  const Vector6d innovation = boxminus(registration.T_target_source, T_track_guess);
  return innovation.dot(inverse_in(space_, covariance) * innovation) <= kLargestMahalanobis2;
}

Tracker::Estimate Tracker::estimate(const Surface& surface, const Pose& T_track_guess,
                                    const Matrix6d& covariance) {
  RegistrationOptions options;
  options.space = space_;
  options.prior = PosePrior{T_track_guess, inverse_in(space_, covariance)};
  const Registration registration =
      register_surface(surface, map_.target(), T_track_guess, options);
  if (!is_trusted(registration, T_track_guess, covariance)) {
    ++counts_.odometry_only;
    return {T_track_guess, Matrix6d::Zero(), false};
  }
  ++counts_.registered;
  return {registration.T_target_source, registration.information, true};
}

void Tracker::add_keyframe(const Observation& observation, const Estimate& estimate,
                           Surface surface) {
  if (!track_.keyframes.empty()) {
    const Keyframe& previous = track_.keyframes.back();
    const Pose T_a_b = relative_pose(previous.T_track_robot, estimate.T_track_robot);
    const Matrix6d by_registration =
        compose_information(space_, T_a_b, information_keyframe_, estimate.information);
    const Matrix6d by_odometry = inverse_in(space_, covariance_since_keyframe_);
    track_.odometry.push_back({previous.id, previous.id + 1, ConstraintKind::odometry, T_a_b,
                               by_registration + by_odometry});
    if (estimate.registered && odometry_unbroken_) odometry_.learn(T_keyframe_odometry_, T_a_b);
  }
  track_.keyframes.push_back({static_cast<int>(track_.keyframes.size()), observation.index,
                              observation.stamp_s, estimate.T_track_robot});
  map_.add(estimate.T_track_robot, std::move(surface));
  T_keyframe_odometry_ = Pose{};
  covariance_since_keyframe_.setZero();
  information_keyframe_ = estimate.information;
  odometry_unbroken_ = true;
}

}  // namespace hmt::submap
