// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "hmt/graph/pose_graph.hpp"
#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/registration/sighting.hpp"
#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// Everything that a log of landmarks measured, as it was measured: one node an observation, in the
/// order of the log, joined by the odometry between them, and the landmarks as points, in the order
/// of landmarks_seen(). Starts from the keyframes' poses, the observations where they hang on them.
/// The first observation is held.
graph::PoseGraph observation_graph(const Track& track, std::span<const Pose> T_world_keyframe,
                                   std::span<const Sighting> sightings,
                                   const ObservationStore& observations);

/// The track with its observations where the nodes of observation_graph() are. Keyframes stay as
/// the front end had them.
Track hang_on_keyframes(Track track, std::span<const Pose> T_world_observation);

}  // namespace hmt::submap
