// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/overlap/keyframe_landmarks.hpp"

#include <Eigen/LU>
#include <string>

namespace hmt::submap {
namespace {

/// Sum of the sightings of one landmark from one keyframe.
struct Sum {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();

  void add(const Sighting& s) {
    information += s.information;
    weighted += s.information * s.p_keyframe;
  }

  Landmark mean(Space space) const {
    const Eigen::Index size = space == Space::se2 ? 2 : 3;
    const Eigen::MatrixXd covariance = information.topLeftCorner(size, size).inverse();
    Landmark landmark;
    landmark.covariance_sensor.topLeftCorner(size, size) =
        (covariance + covariance.transpose()) / 2;
    landmark.position_sensor.head(size) = covariance * weighted.head(size);
    return landmark;
  }
};

}  // namespace

KeyframeLandmarks::KeyframeLandmarks(const Track& track, std::span<const Sighting> sightings,
                                     std::span<const int64_t> names,
                                     const ObservationStore& observations)
    : observations_(observations) {
  std::vector<std::map<int, Sum>> sums(track.keyframes.size());
  for (const Sighting& s : sightings) sums.at(static_cast<size_t>(s.keyframe))[s.landmark].add(s);
  for (const Keyframe& keyframe : track.keyframes) {
    LandmarkReading& reading = by_observation_[keyframe.observation];
    for (const auto& [number, sum] : sums[static_cast<size_t>(keyframe.id)]) {
      reading.landmarks.push_back(sum.mean(track.space));
      if (names[static_cast<size_t>(number)] != kUnknownLandmark)
        reading.landmarks.back().id = number;
    }
  }
}

std::shared_ptr<const Observation> KeyframeLandmarks::load(int64_t index) const {
  const auto found = by_observation_.find(index);
  if (found == by_observation_.end())
    throw InputError("observation " + std::to_string(index) + " is of no keyframe");
  auto observation = std::make_shared<Observation>(*observations_.load(index));
  observation->landmark_readings.clear();
  if (observation->readings.empty() || !found->second.landmarks.empty())
    observation->landmark_readings.push_back(found->second);
  return observation;
}

}  // namespace hmt::submap
