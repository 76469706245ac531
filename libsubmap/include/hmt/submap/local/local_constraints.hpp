// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/graph/weighted_graph.hpp"
#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/track.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

struct LocalConstraintOptions {
  /// Keyframe pairs with less overlap are not registered, (0, 1].
  double min_overlap = 0.2;
  /// Surfaces that are kept for the next registration take up to so many bytes: a thousand planar
  /// scans, or some dozen large clouds. Without effect on the result.
  size_t surface_cache_bytes = size_t{32} << 20;
};

/// Registers overlapping keyframes onto each other, at the given poses. Of each keyframe's
/// neighbors in Omega those of most overlap are taken: a few of the same visit, and a few of every
/// other visit to the place, so that cost stays linear in the number of keyframes. A registration
/// counts if it converged, explains what the overlap promised, and agrees with the prediction under
/// its covariance. Ordered by (a, b); same result for any number of threads.
std::vector<Constraint> register_overlapping(Space space, std::span<const Keyframe> keyframes,
                                             std::span<const Pose> T_world_keyframe,
                                             const graph::WeightedGraph& overlap,
                                             std::span<const Constraint> known,
                                             const PairCovariance& covariance,
                                             const ObservationStore& observations,
                                             const LocalConstraintOptions& options, const Run& run);

}  // namespace hmt::submap
