// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_noise.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "hmt/graph/chi_squared.hpp"
#include "landmark_filter.hpp"

namespace hmt::submap {
namespace {

// Deviations of a measured position: along the line of sight, at no distance and by its distance;
// across it, in radians.
constexpr double kRange_m = 0.1;
constexpr double kRangeShare = 0.05;
constexpr double kBearing_rad = 0.02;
// Deviations of odometry: metres per square root of a metre, radians per square root of a radian.
constexpr double kOdometry = 0.1;
constexpr double kHeading = 0.3;
// Turning by a radian moves the wheels of a robot about as much as driving this far.
constexpr double kTurnLength_m = 0.3;
/// Radians of a turn that are as uncertain as a metre of way.
constexpr double kTurnPerMetre_rad = 0.33;
/// At rest a robot may still shift by so much from one observation to the next.
constexpr double kRest_m = 1e-3;
constexpr double kRest_rad = 5e-4;
/// Keyframes apart from which two sightings of a landmark are of different views.
constexpr double kNewView = 4;

double turn_rad(const Pose& T) {
  return 2 * std::atan2(T.rotation.vec().norm(), std::abs(T.rotation.w()));
}

/// Of an odometry step (tangent of Pose, frame of its end).
Matrix6d covariance_of_step(Space space, const Pose& step) {
  const double distance_m = step.translation.norm();
  const double angle_rad = turn_rad(step);
  const double translation =
      kRest_m * kRest_m + kOdometry * kOdometry * (distance_m + kTurnLength_m * angle_rad);
  const double rotation =
      kRest_rad * kRest_rad + kHeading * kHeading * (angle_rad + kTurnPerMetre_rad * distance_m);
  Vector6d variances;
  variances << translation, translation, translation, rotation, rotation, rotation;
  if (space == Space::se2) variances.segment<3>(2).setZero();
  return variances.asDiagonal();
}

bool has_moved(const Pose& T_odom_before, const Pose& T_odom_now, const TrackOptions& options) {
  const Pose T = graph::relative_pose(T_odom_before, T_odom_now);
  return T.translation.norm() >= kNewView * options.keyframe_distance_m ||
         turn_rad(T) >= kNewView * options.keyframe_angle_rad;
}

void fill_in_landmarks(std::vector<Observation>& observations, Space space,
                       const TrackOptions& options) {
  LandmarkViews views(options);
  std::vector<size_t> view_of;  // by sighting
  for (const Observation& observation : observations)
    for (const LandmarkReading& reading : observation.landmark_readings)
      for (const Landmark& landmark : reading.landmarks)
        view_of.push_back(views.add(landmark.id, observation.T_odom_robot));
  size_t sighting = 0;
  for (Observation& observation : observations)
    for (LandmarkReading& reading : observation.landmark_readings)
      for (Landmark& landmark : reading.landmarks) {
        const int same_view = views.size(view_of[sighting++]);
        if (landmark.covariance_sensor.isZero(0))
          landmark.covariance_sensor =
              same_view * ordinary_covariance(space, landmark.position_sensor);
      }
}

/// A sighting that a filter with the right noise hardly ever makes is not learnt from.
constexpr double kFalseSighting = 0.999;

void learn(const Observation& observation, double gate2, LandmarkFilter& filter) {
  for (const LandmarkReading& reading : observation.landmark_readings)
    for (const Landmark& landmark : reading.landmarks) {
      if (landmark.id == kUnknownLandmark) continue;
      const Eigen::Matrix3d R = reading.T_robot_sensor.rotation_matrix();
      const MeasuredLandmark measured{reading.T_robot_sensor * landmark.position_sensor,
                                      R * landmark.covariance_sensor * R.transpose()};
      const auto id = static_cast<int>(landmark.id);
      const auto innovation = filter.innovation(id, measured);
      if (!innovation)
        filter.insert(id, measured);
      else if (innovation->mahalanobis_squared <= gate2)
        filter.update(id, measured);
    }
}

/// What a filter over the whole log makes out, by the named landmarks, of the odometry of which the
/// log does not tell the covariance.
OdometryErrors find_odometry_errors(const std::vector<Observation>& observations) {
  LandmarkFilter filter(Space::se2, Pose{}, odometry_error_deviations());
  const double gate2 = graph::chi_squared_quantile(2, kFalseSighting);
  const Observation* latest = &observations.front();
  for (const Observation& observation : observations) {
    const Pose step = graph::relative_pose(latest->T_odom_robot, observation.T_odom_robot);
    if (observation.motion_covariance)
      filter.predict(step, *observation.motion_covariance);
    else
      filter.predict_told(step, observation.stamp_s - latest->stamp_s,
                          covariance_of_step(Space::se2, step));
    latest = &observation;
    learn(observation, gate2, filter);
  }
  return filter.odometry_errors();
}

void fill_in_motion(std::vector<Observation>& observations, Space space,
                    const OdometryErrors& errors) {
  Pose T_told_latest = observations.front().T_odom_robot;
  double stamp_latest_s = observations.front().stamp_s;
  Pose T_odom_robot = T_told_latest;
  for (Observation& observation : observations) {
    Pose step = graph::relative_pose(T_told_latest, observation.T_odom_robot);
    if (!observation.motion_covariance) {
      observation.motion_covariance = covariance_of_step(space, step);
      step = without_errors(step, observation.stamp_s - stamp_latest_s, errors);
    }
    T_told_latest = observation.T_odom_robot;
    stamp_latest_s = observation.stamp_s;
    observation.T_odom_robot = T_odom_robot = T_odom_robot * step;
  }
}

}  // namespace

Eigen::Matrix3d ordinary_covariance(Space space, const Eigen::Vector3d& position_sensor) {
  const double range_m = position_sensor.norm();
  const double along = kRange_m * kRange_m + std::pow(kRangeShare * range_m, 2);
  const double across = std::pow(kBearing_rad * range_m, 2);
  const Eigen::Vector3d sight =
      range_m > 0 ? Eigen::Vector3d(position_sensor / range_m) : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d covariance =
      across * Eigen::Matrix3d::Identity() + (along - across) * sight * sight.transpose();
  if (space == Space::se2) {
    covariance.row(2).setZero();
    covariance.col(2).setZero();
  }
  return covariance;
}

size_t LandmarkViews::add(int64_t name, const Pose& T_odom_robot) {
  const auto found = latest_.find(name);
  if (name == kUnknownLandmark || found == latest_.end() ||
      has_moved(found->second.T_odom_robot, T_odom_robot, options_)) {
    latest_[name] = {T_odom_robot, sizes_.size()};
    sizes_.push_back(0);
  }
  const size_t view = latest_[name].view;
  ++sizes_[view];
  return view;
}

std::vector<Observation> with_noise(std::vector<Observation> observations, Space space,
                                    const TrackOptions& options) {
  fill_in_landmarks(observations, space, options);
  // The first observation has no motion before it.
  const bool all_told = std::all_of(observations.begin() + 1, observations.end(),
                                    [](const Observation& o) { return o.motion_covariance; });
  const OdometryErrors errors = all_told || space == Space::se3
                                    ? OdometryErrors::Zero().eval()
                                    : find_odometry_errors(observations);
  fill_in_motion(observations, space, errors);
  return observations;
}

}  // namespace hmt::submap
