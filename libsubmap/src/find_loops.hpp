// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/submap/link/loop_search.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/track.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// Where loops are searched: keyframes at their poses, and what is known of these.
struct LoopSearch {
  const Track& track;
  std::span<const Pose> T_world_keyframe;
  std::span<const Constraint> constraints;
  std::span<const Sighting> sightings;
  std::span<const int> submap_of_keyframe;
  std::span<const LoopCandidate> decided;  ///< earlier ones; what the user rejected stays so
  int first_query = 0;                     ///< as in LoopProblem
  double query_spacing_m = LoopProblem{}.query_spacing_m;
};

/// The candidates of a search, judged together: see search_loops and consistent_loops.
std::vector<LoopCandidate> find_loops(const LoopSearch& search,
                                      const ObservationStore& observations, const Run& run);

bool has_closure(std::span<const LoopCandidate> candidates);

/// The constraints and those that the closures are worth.
std::vector<Constraint> with_closures(std::vector<Constraint> constraints,
                                      std::span<const LoopCandidate> candidates);

/// Closures among the outliers of the robust optimization are none.
void mark_outliers(std::vector<LoopCandidate>& candidates, std::span<const Constraint> outliers);

}  // namespace hmt::submap
