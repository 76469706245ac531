// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/link/correlative_search.hpp"
#include "loop_confirm.hpp"
#include "loop_patch.hpp"
#include "loop_proposals.hpp"

namespace hmt::submap {

/// The map around a place, to be searched by many queries, one after the other.
class LoopMap {
 public:
  LoopMap(const LoopProblem& problem, LoopPatch patch);
  LoopMap(const LoopMap&) = delete;
  LoopMap& operator=(const LoopMap&) = delete;

  const LoopPatch& patch() const { return patch_; }
  const CorrelativeGrid& grid() const { return grid_; }
  LoopConfirmer& confirmer() { return confirmer_; }

 private:
  LoopPatch patch_;
  CorrelativeGrid grid_;
  LoopConfirmer confirmer_;
};

/// Searches the query in the map and judges the best match. An accepted candidate's `a` is the
/// keyframe of the map that stands nearest to b.
LoopCandidate examine_loop(const LoopProblem& problem, std::span<const PlanarScan> scans,
                           LoopMap& map, const LoopPatch& query, const LoopProposal& proposal);

}  // namespace hmt::submap
