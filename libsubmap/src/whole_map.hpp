// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/graph/pose_graph.hpp"
#include "hmt/submap/map/hybrid_map.hpp"
#include "hmt/submap/map/map_file.hpp"

namespace hmt::submap {

std::vector<int> all_keyframes(const Track& track);

/// Whether range sensors saw what the map is made of; otherwise all of it are landmarks.
bool has_scans(const Track& track, const ObservationStore& observations);

/// The graph of all keyframes and of the landmarks that they sighted, the first keyframe fixed.
graph::PoseGraph graph_of_all(const Track& track, std::span<const Pose> T_world_keyframe,
                              std::span<const Constraint> constraints,
                              std::span<const Sighting> sightings);

/// T_world_keyframe of every keyframe by its submap.
std::vector<Pose> keyframe_poses(const HybridMap& map);

/// The same submaps and links with the keyframes at the given poses.
void move_submaps(HybridMap& map, std::span<const Pose> T_world_keyframe);

/// Covariances of the submaps and of the landmarks sighted in the world, by the graph of all
/// keyframes with the poses and points of the map.
void add_covariances(const graph::PoseGraph& all, const Track& track,
                     std::span<const Submap> submaps, std::span<const Sighting> sightings,
                     MapSolution& solution);

}  // namespace hmt::submap
