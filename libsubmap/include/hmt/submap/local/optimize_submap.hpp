// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/graph/partition.hpp"
#include "hmt/graph/pose_graph.hpp"
#include "hmt/submap/local/submap.hpp"
#include "hmt/submap/registration/constraint.hpp"

namespace hmt::submap {

/// The pose graph of some keyframes, the constraints among them, and what they saw of landmarks.
/// `keyframes`: the nodes, increasing; `constraints`: those with both ends inside are used, in
/// their order; so are the sightings from a keyframe inside. The points are landmarks_seen() in
/// their order, where the given poses see them.
graph::PoseGraph keyframe_graph(Space space, std::span<const int> keyframes,
                                std::span<const Pose> T_frame_keyframe,
                                std::span<const Constraint> constraints,
                                std::span<const Sighting> sightings = {});

/// Numbers of the landmarks seen from some keyframes (increasing), increasing.
std::vector<int> landmarks_seen(std::span<const int> keyframes,
                                std::span<const Sighting> sightings);

/// Everything that the optimization of one submap needs. A job is a value: it can be stored, sent
/// and run anywhere.
struct SubmapJob {
  Space space = Space::se2;
  int id = 0;
  std::vector<int> keyframes;        ///< increasing
  std::vector<Pose> T_any_keyframe;  ///< start, in any common frame
  std::vector<int> constraint_ids;   ///< their indices in the map
  std::vector<Constraint> constraints;
  std::vector<Sighting> sightings;  ///< from its keyframes

  bool operator==(const SubmapJob&) const = default;
};

/// One job a submap, by the partition.
std::vector<SubmapJob> make_submap_jobs(Space space, const graph::Labels& submap_of_keyframe,
                                        std::span<const Pose> T_world_keyframe,
                                        std::span<const Constraint> constraints,
                                        std::span<const Sighting> sightings = {});

/// Optimizes the keyframes and landmarks of one submap together in its own frame, which is that of
/// its first keyframe, with the covariance of each. Uses one thread. Throws InputError if
/// constraints and sightings do not tie the keyframes together.
Submap optimize_submap(const SubmapJob& job);

}  // namespace hmt::submap
