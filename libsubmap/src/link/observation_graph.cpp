// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/observation_graph.hpp"

#include <algorithm>
#include <map>

#include "hmt/graph/pose_initialization.hpp"

namespace hmt::submap {
namespace {

/// Inverse over the coordinates that the space has.
template <int kSize>
Eigen::Matrix<double, kSize, kSize> information_of(
    const Eigen::Matrix<double, kSize, kSize>& covariance, const std::vector<int>& used) {
  const Eigen::MatrixXd inverse = covariance(used, used).inverse();
  Eigen::Matrix<double, kSize, kSize> information = Eigen::Matrix<double, kSize, kSize>::Zero();
  information(used, used) = (inverse + inverse.transpose()) / 2;
  return information;
}

/// The landmark at that place of an observation, as a measurement of a point.
graph::PointEdge measured(const Observation& observation, const Sighting& sighting, Space space) {
  size_t place = static_cast<size_t>(sighting.place);
  for (const LandmarkReading& reading : observation.landmark_readings) {
    if (place >= reading.landmarks.size()) {
      place -= reading.landmarks.size();
      continue;
    }
    const Landmark& landmark = reading.landmarks[place];
    const Eigen::Matrix3d R = reading.T_robot_sensor.rotation_matrix();
    const Eigen::Matrix3d covariance = R * landmark.covariance_sensor * R.transpose();
    const std::vector<int> used =
        space == Space::se2 ? std::vector<int>{0, 1} : std::vector<int>{0, 1, 2};
    return {static_cast<int>(sighting.observation), sighting.landmark,
            reading.T_robot_sensor * landmark.position_sensor, information_of(covariance, used)};
  }
  throw InputError("observation " + std::to_string(observation.index) + " has no landmark " +
                   std::to_string(sighting.place));
}

}  // namespace

graph::PoseGraph observation_graph(const Track& track, std::span<const Pose> T_world_keyframe,
                                   std::span<const Sighting> sightings,
                                   const ObservationStore& observations) {
  const std::vector<int> used =
      track.space == Space::se2 ? std::vector<int>{0, 1, 5} : std::vector<int>{0, 1, 2, 3, 4, 5};
  graph::PoseGraph graph;
  graph.space = track.space;
  if (!track.observations.empty()) graph.fixed = {0};
  std::map<int, int> point_of;  // by landmark
  for (const Sighting& s : sightings) point_of[s.landmark] = 0;
  int points = 0;
  for (auto& [landmark, point] : point_of) point = points++;
  graph.points.resize(point_of.size(), Eigen::Vector3d::Zero());
  Pose T_odom_before;
  auto sighting = sightings.begin();
  for (const TrackedObservation& tracked : track.observations) {
    const auto observation = observations.load(tracked.observation);
    const auto node = static_cast<int>(graph.poses.size());
    graph.poses.push_back(T_world_keyframe[static_cast<size_t>(tracked.keyframe)] *
                          tracked.T_keyframe_robot);
    if (node > 0 && observation->motion_covariance)
      graph.edges.push_back({node - 1, node,
                             relative_pose(T_odom_before, observation->T_odom_robot),
                             information_of(*observation->motion_covariance, used)});
    T_odom_before = observation->T_odom_robot;
    for (; sighting != sightings.end() && sighting->observation == tracked.observation;
         ++sighting) {
      graph.point_edges.push_back(measured(*observation, *sighting, track.space));
      graph.point_edges.back().node = node;
      graph.point_edges.back().point = point_of.at(sighting->landmark);
    }
  }
  graph.points = graph::place_points(graph, graph.poses);
  return graph;
}

Track hang_on_keyframes(Track track, std::span<const Pose> T_world_observation) {
  Pose T_world_keyframe;
  int keyframe = -1;
  for (size_t k = 0; k < track.observations.size(); ++k) {
    TrackedObservation& tracked = track.observations[k];
    // A keyframe is the first observation that hangs on it.
    if (tracked.keyframe != keyframe) T_world_keyframe = T_world_observation[k];
    keyframe = tracked.keyframe;
    tracked.T_keyframe_robot = relative_pose(T_world_keyframe, T_world_observation[k]);
  }
  return track;
}

}  // namespace hmt::submap
