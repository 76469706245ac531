// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_sightings.hpp"

#include <Eigen/LU>

namespace hmt::submap {
namespace {

/// Of a place in the frame of the robot, by the noise of the robot's pose.
Eigen::Matrix3d carried_covariance(const Eigen::Vector3d& p_robot, const Matrix6d& covariance) {
  const Eigen::Vector3d& p = p_robot;
  Eigen::Matrix<double, 3, 6> J;
  J << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero();
  J.rightCols<3>() << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
  return J * covariance * J.transpose();
}

/// Inverse over the coordinates that the space has.
Eigen::Matrix3d information_of(Space space, const Eigen::Matrix3d& covariance) {
  const Eigen::Index size = space == Space::se2 ? 2 : 3;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information.topLeftCorner(size, size) = covariance.topLeftCorner(size, size).inverse();
  return (information + information.transpose()) / 2;
}

}  // namespace

int LandmarkNumbers::of(int64_t name) {
  const auto found = number_of_.find(name);
  if (found != number_of_.end()) return found->second;
  return number_of_[name] = add(name);
}

int LandmarkNumbers::add(int64_t name) {
  names_.push_back(name);
  return static_cast<int>(names_.size()) - 1;
}

MeasuredLandmark in_robot(const LandmarkReading& reading, const Landmark& landmark) {
  const Eigen::Matrix3d R = reading.T_robot_sensor.rotation_matrix();
  return {reading.T_robot_sensor * landmark.position_sensor,
          R * landmark.covariance_sensor * R.transpose()};
}

Sighting carried_to_keyframe(Space space, const MeasuredLandmark& measured,
                             const Pose& T_keyframe_robot, const Matrix6d& covariance) {
  const Eigen::Matrix3d R = T_keyframe_robot.rotation_matrix();
  const Eigen::Matrix3d of_place =
      R * (measured.covariance + carried_covariance(measured.p_robot, covariance)) * R.transpose();
  Sighting sighting;
  sighting.p_keyframe = T_keyframe_robot * measured.p_robot;
  sighting.information = information_of(space, of_place);
  return sighting;
}

void LandmarkSightings::add(const Observation& observation, const TrackedObservation& tracked,
                            const Matrix6d& covariance) {
  int place = -1;
  for (const LandmarkReading& reading : observation.landmark_readings)
    for (Landmark landmark : reading.landmarks) {
      ++place;
      if (landmark.id == kUnknownLandmark) {
        ++unnamed_;
        continue;
      }
      Seen seen;
      seen.is_told = !landmark.covariance_sensor.isZero(0);
      if (!seen.is_told)
        landmark.covariance_sensor = ordinary_covariance(space_, landmark.position_sensor);
      const MeasuredLandmark measured = in_robot(reading, landmark);
      const Eigen::Matrix3d R = tracked.T_keyframe_robot.rotation_matrix();
      seen.measured = R * measured.covariance * R.transpose();
      seen.carried = R * carried_covariance(measured.p_robot, covariance) * R.transpose();
      seen.view = views_.add(landmark.id, observation.T_odom_robot);
      seen.sighting.observation = observation.index;
      seen.sighting.place = place;
      seen.sighting.keyframe = tracked.keyframe;
      seen.sighting.landmark = numbers_.of(landmark.id);
      seen.sighting.p_keyframe = tracked.T_keyframe_robot * measured.p_robot;
      seen_.push_back(seen);
    }
}

std::vector<Sighting> LandmarkSightings::take() {
  std::vector<Sighting> sightings;
  for (const Seen& seen : seen_) {
    const double alike = seen.is_told ? 1 : views_.size(seen.view);
    sightings.push_back(seen.sighting);
    sightings.back().information = information_of(space_, alike * seen.measured + seen.carried);
  }
  return sightings;
}

}  // namespace hmt::submap
