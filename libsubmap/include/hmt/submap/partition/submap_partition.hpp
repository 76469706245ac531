// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "hmt/graph/partition.hpp"
#include "hmt/graph/weighted_graph.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/sighting.hpp"

namespace hmt::submap {

struct SubmapPartitionOptions {
  /// Bisections with an Ncut below tau are made, (0, 2) [Blanco 2009, Table 1]; raising it gives
  /// more, smaller submaps.
  double tau = 2.0 / 3.0;
  /// Groups of fewer keyframes are not cut any further, >= 1.
  int min_keyframes = 8;
  /// Partition as a robot would on its way (SubmapManager) instead of the whole at once.
  bool sequential = false;
  /// Keyframes that the sequential partition holds at most, >= 2; raising it tells places apart
  /// that the robot sees for longer, at a cost of each step that is linear in it.
  int max_window = 200;
};

/// Submap of each keyframe: the recursive min-Ncut partition of Omega, then made fit for local
/// optimization. A group whose keyframes firm constraints (is_firm) do not tie together falls into
/// its connected pieces; pieces that saw as many common landmarks as fix a pose, two in the plane
/// and three in space, are one. A piece of fewer than three keyframes joins the submap that it
/// shares most constraints with (by count; the smaller id on a tie). So every submap is connected
/// by what it holds, and every keyframe is in exactly one.
graph::Labels partition_keyframes(Space space, const graph::WeightedGraph& overlap,
                                  std::span<const Constraint> constraints,
                                  std::span<const Sighting> sightings,
                                  const SubmapPartitionOptions& options, int threads);

}  // namespace hmt::submap
