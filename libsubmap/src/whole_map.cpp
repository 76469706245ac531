// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "whole_map.hpp"

#include <numeric>

#include "hmt/graph/pose_covariance.hpp"
#include "hmt/submap/local/optimize_submap.hpp"

namespace hmt::submap {

std::vector<int> all_keyframes(const Track& track) {
  std::vector<int> all(track.keyframes.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

bool has_scans(const Track& track, const ObservationStore& observations) {
  // Scans make the observations where there are any.
  return !track.observations.empty() &&
         !observations.load(track.observations.front().observation)->readings.empty();
}

graph::PoseGraph graph_of_all(const Track& track, std::span<const Pose> T_world_keyframe,
                              std::span<const Constraint> constraints,
                              std::span<const Sighting> sightings) {
  graph::PoseGraph graph =
      keyframe_graph(track.space, all_keyframes(track), T_world_keyframe, constraints, sightings);
  if (!graph.poses.empty()) graph.fixed = {0};
  return graph;
}

std::vector<Pose> keyframe_poses(const HybridMap& map) {
  std::vector<Pose> T_world_keyframe;
  for (const Keyframe& keyframe : map.track.keyframes)
    T_world_keyframe.push_back(world_pose(map, keyframe.id));
  return T_world_keyframe;
}

void move_submaps(HybridMap& map, std::span<const Pose> T_world_keyframe) {
  for (Submap& submap : map.submaps) {
    const Pose& T_world_submap = T_world_keyframe[static_cast<size_t>(submap.keyframes.front())];
    map.T_world_submap[static_cast<size_t>(submap.id)] = T_world_submap;
    for (size_t k = 0; k < submap.keyframes.size(); ++k)
      submap.T_submap_keyframe[k] = graph::relative_pose(
          T_world_submap, T_world_keyframe[static_cast<size_t>(submap.keyframes[k])]);
  }
}

void add_covariances(const graph::PoseGraph& all, const Track& track,
                     std::span<const Submap> submaps, std::span<const Sighting> sightings,
                     MapSolution& solution) {
  const std::vector<int> landmarks = landmarks_seen(all_keyframes(track), sightings);
  const graph::PoseCovariance covariance(all);
  solution.covariance_world_submap.clear();
  for (const Submap& submap : submaps)
    solution.covariance_world_submap.push_back(
        covariance.marginal(submap.keyframes.front()).value_or(Matrix6d::Zero()));
  solution.landmarks.clear();
  for (size_t k = 0; k < landmarks.size(); ++k)
    solution.landmarks.push_back(
        {landmarks[k], all.points[k],
         covariance.marginal_point(static_cast<int>(k)).value_or(Eigen::Matrix3d::Zero())});
}

}  // namespace hmt::submap
