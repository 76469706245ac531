// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/graph/partition.hpp"
#include "hmt/graph/pose_graph.hpp"
#include "hmt/graph/weighted_graph.hpp"
#include "hmt/submap/link/link.hpp"
#include "hmt/submap/local/submap.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// One link for each pair of submaps that constraints or landmarks seen from both join. Its
/// relative pose and covariance are those of the joint optimization of the two submaps with all
/// constraints inside them and across the cut and all sightings, the rest of the map left out. Ncut
/// is that of the two submaps' keyframes in Omega (Eq. 1). Information loss is left at 0. Ordered
/// by (a, b); same result for any number of threads.
std::vector<Link> condense_links(Space space, std::span<const Submap> submaps,
                                 const graph::Labels& submap_of_keyframe,
                                 std::span<const Constraint> constraints,
                                 std::span<const Sighting> sightings,
                                 const graph::WeightedGraph& overlap, const Run& run);

/// The graph of submap frames and links.
graph::PoseGraph submap_graph(Space space, std::span<const Pose> T_world_submap,
                              std::span<const Link> links);

}  // namespace hmt::submap
