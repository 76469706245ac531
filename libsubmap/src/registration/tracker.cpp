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
// Information so small (100 m, 100 rad) that it says nothing.
constexpr double kNothing = 1e-4;

Matrix6d diagonal_in(Space space, double translation, double rotation) {
  Vector6d v;
  v << translation, translation, translation, rotation, rotation, rotation;
  if (space == Space::se2) v.segment<3>(2).setZero();
  return v.asDiagonal();
}

Matrix6d unknown_step(Space space) {
  return diagonal_in(space, kUnknownStep_m * kUnknownStep_m, kUnknownStep_rad * kUnknownStep_rad);
}

// Observations in a row after which the odometry is not trusted less and less any more.
constexpr int kMostRefused = 10;

double rotation_angle_rad(const Pose& T) {
  return 2 * std::atan2(T.rotation.vec().norm(), std::abs(T.rotation.w()));
}

}  // namespace

Tracker::Tracker(Space space, const TrackOptions& options)
    : space_(space),
      options_(options),
      step_odometry_(space),
      keyframe_odometry_(space),
      steady_(OdometryModel::of_unknown_motion(space)) {
  track_.space = space;
}

void Tracker::start(const Observation& observation, Surface surface) {
  T_track_latest_ = observation.T_odom_robot;
  add_keyframe(observation,
               {T_track_latest_, diagonal_in(space_, kDefining, kDefining), true, T_track_latest_},
               std::move(surface));
  information_latest_ = information_keyframe_;
}

void Tracker::add(const Observation& observation, Surface surface) {
  if (track_.keyframes.empty()) {
    start(observation, std::move(surface));
  } else {
    const Motion motion = predict_step(observation);
    const Pose& step = motion.step;
    Matrix6d step_covariance = motion.covariance;
    // Where the odometry's word was taken against the surfaces, it is trusted less and less.
    step_covariance *= std::exp2(2 * std::min(refused_, kMostRefused));
    T_keyframe_odometry_ = T_keyframe_odometry_ * step;
    const Matrix6d covariance = compose_covariance(step, covariance_latest_, step_covariance);
    const Prediction prediction{T_track_latest_ * step, T_track_latest_, covariance,
                                inverse_in(space_, covariance), step.translation.norm()};
    const Estimate found = estimate(surface, prediction);
    learn_odometry(motion, prediction, found);
    latest_step_ = relative_pose(T_track_latest_, found.T_track_robot);
    latest_duration_s_ = motion.duration_s;
    T_track_latest_ = found.T_track_robot;
    information_latest_ = found.information;
    covariance_latest_ =
        found.registered ? inverse_in(space_, inverse_in(space_, covariance) + found.information)
                         : covariance;
    if (is_keyframe(found)) add_keyframe(observation, found, std::move(surface));
  }
  T_odom_latest_ = observation.T_odom_robot;
  stamp_latest_s_ = observation.stamp_s;
  const Keyframe& keyframe = track_.keyframes.back();
  track_.observations.push_back({observation.index, observation.stamp_s, keyframe.id,
                                 relative_pose(keyframe.T_track_robot, T_track_latest_)});
}

bool Tracker::is_keyframe(const Estimate& estimate) {
  if (space_ == Space::se3 && !odometry_moves_ && !estimate.registered) {
    // Nothing tells where it is: what comes is tracked from here.
    map_.forget();
    ++counts_.lost;
    return true;
  }
  const Pose T_keyframe_robot =
      relative_pose(track_.keyframes.back().T_track_robot, estimate.T_track_robot);
  return T_keyframe_robot.translation.norm() >= options_.keyframe_distance_m ||
         rotation_angle_rad(T_keyframe_robot) >= options_.keyframe_angle_rad;
}

Tracker::Motion Tracker::predict_step(const Observation& observation) {
  Motion motion;
  motion.odometry = relative_pose(T_odom_latest_, observation.T_odom_robot);
  motion.duration_s = std::max(0.0, observation.stamp_s - stamp_latest_s_);
  if (!OdometryModel::is_motion(motion.odometry)) {
    motion.covariance = unknown_step(space_);
    odometry_unbroken_ = false;
    ++counts_.odometry_jumps;
    return motion;
  }
  odometry_moves_ = odometry_moves_ || !OdometryModel::is_rest(motion.odometry);
  if (!odometry_moves_) {
    const double longer = latest_duration_s_ > 0 ? motion.duration_s / latest_duration_s_ : 1;
    motion.step = boxplus(Pose{}, std::min(longer, 2.0) * boxminus(latest_step_, Pose{}));
    motion.covariance = steady_.covariance(motion.step);
    odometry_unbroken_ = false;
    return motion;
  }
  motion.by_odometry = odometry_unbroken_;
  motion.step = space_ == Space::se2 ? calibration_.corrected(motion.odometry, motion.duration_s)
                                     : motion.odometry;
  motion.covariance = step_odometry_.covariance(motion.step);
  return motion;
}

void Tracker::learn_odometry(const Motion& motion, const Prediction& prediction,
                             const Estimate& found) {
  if (!found.registered) return;
  const Matrix6d noise = inverse_in(space_, found.information + kNothing * Matrix6d::Identity());
  if (motion.by_odometry && space_ == Space::se2) {
    const Eigen::Array3i plane(0, 1, 5);
    const Vector6d free = boxminus(found.T_track_measured, prediction.T_map_robot);
    const Eigen::Matrix3d covariance = (noise + prediction.covariance)(plane, plane);
    const Eigen::Array2i along(0, 2);
    calibration_.learn(motion.odometry, motion.duration_s, free(plane)(along),
                       covariance(along, along));
  }
  const Pose measured = relative_pose(T_track_latest_, found.T_track_robot);
  if (space_ == Space::se3) {
    if (motion.by_odometry)
      step_odometry_.learn(
          motion.step, relative_pose(T_track_latest_, found.T_track_measured),
          (noise + compose_covariance(motion.step, covariance_latest_, Matrix6d::Zero()))
              .diagonal());
    if (!odometry_moves_) steady_.learn(motion.step, measured, Vector6d::Zero());
    return;
  }
  if (!observes_all(space_, found.information, prediction.information)) return;
  if (motion.by_odometry) step_odometry_.learn(motion.step, measured, Vector6d::Zero());
  if (!odometry_moves_) steady_.learn(motion.step, measured, Vector6d::Zero());
}

Tracker::Estimate Tracker::estimate(const Surface& surface, const Prediction& prediction) {
  const LocatedSurface located = locate(space_, surface, map_, prediction, !odometry_moves_);
  const Registration& found = located.registration;
  if (!located.fits) {
    ++counts_.odometry_only;
    if (found.termination != Registration::Termination::too_few_points) ++refused_;
    return {prediction.T_map_robot, Matrix6d::Zero(), false, prediction.T_map_robot};
  }
  if (located.searched) ++counts_.searched;
  ++counts_.registered;
  refused_ = 0;
  // The estimate lies between the prediction p and what the surfaces alone say, m:
  // x - p = (I + P)^-1 I (m - p) with their informations I and P.
  const Vector6d moved = boxminus(found.T_target_source, prediction.T_map_robot);
  const Matrix6d noise = inverse_in(space_, found.information + kNothing * Matrix6d::Identity());
  const Vector6d free = moved + noise * (prediction.information * moved);
  return {found.T_target_source, found.information, true, boxplus(prediction.T_map_robot, free)};
}

void Tracker::add_keyframe(const Observation& observation, const Estimate& estimate,
                           Surface surface) {
  if (!track_.keyframes.empty()) {
    const Keyframe& previous = track_.keyframes.back();
    const Pose T_a_b = relative_pose(previous.T_track_robot, estimate.T_track_robot);
    const Matrix6d by_registration =
        compose_information(space_, T_a_b, information_keyframe_, estimate.information);
    Matrix6d by_odometry =
        odometry_unbroken_ ? inverse_in(space_, keyframe_odometry_.covariance(T_keyframe_odometry_))
                           : inverse_in(space_, unknown_step(space_));
    // Odometry that the surfaces contradict is as wrong as they say.
    const Vector6d error = boxminus(T_a_b, T_keyframe_odometry_);
    const double unknowns = space_ == Space::se2 ? 3 : 6;
    by_odometry /= std::max(1.0, error.dot(by_odometry * error) / unknowns);
    track_.odometry.push_back({previous.id, previous.id + 1, ConstraintKind::odometry, T_a_b,
                               by_registration + by_odometry});
    if (space_ == Space::se3)
      chain_.push_back({T_keyframe_odometry_, T_a_b, estimate.information, odometry_unbroken_});
    if (odometry_unbroken_ && space_ == Space::se3 && estimate.registered)
      keyframe_odometry_.learn(
          T_keyframe_odometry_, relative_pose(previous.T_track_robot, estimate.T_track_measured),
          inverse_in(space_, by_registration + kNothing * Matrix6d::Identity()).diagonal());
    else if (odometry_unbroken_ && observes_all(space_, by_registration, by_odometry))
      keyframe_odometry_.learn(T_keyframe_odometry_, T_a_b, Vector6d::Zero());
  }
  track_.keyframes.push_back({static_cast<int>(track_.keyframes.size()), observation.index,
                              observation.stamp_s, estimate.T_track_robot});
  map_.add(estimate.T_track_robot, std::move(surface));
  T_keyframe_odometry_ = Pose{};
  information_keyframe_ = estimate.information;
  odometry_unbroken_ = true;
}

Matrix6d Tracker::covariance_keyframe_robot() const {
  const Matrix6d by_registration = compose_information(space_, latest().T_keyframe_robot,
                                                       information_keyframe_, information_latest_);
  const Matrix6d by_odometry =
      inverse_in(space_, odometry_unbroken_ ? keyframe_odometry_.covariance(T_keyframe_odometry_)
                                            : unknown_step(space_));
  return inverse_in(space_, by_registration + by_odometry);
}

Track Tracker::take() {
  const std::optional<std::vector<WeighedStep>> weighed = weigh_chain(chain_);
  for (size_t k = 0; weighed && k < chain_.size(); ++k) {
    Constraint& step = track_.odometry[k];
    if (chain_[k].has_odometry) {
      step.T_a_b = (*weighed)[k].T_a_b;
      step.information = (*weighed)[k].information;
    }
    track_.keyframes[k + 1].T_track_robot = track_.keyframes[k].T_track_robot * step.T_a_b;
  }
  return std::move(track_);
}

}  // namespace hmt::submap
