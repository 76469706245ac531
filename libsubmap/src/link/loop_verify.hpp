// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "hmt/submap/link/correlative_search.hpp"
#include "loop_patch.hpp"
#include "loop_proposals.hpp"

namespace hmt::submap {

/// The map around a place, ready to be searched by many queries.
class LoopMap {
 public:
  LoopMap(const LoopProblem& problem, LoopPatch patch);

  const LoopPatch& patch() const { return patch_; }
  const CorrelativeGrid& grid() const { return grid_; }
  /// Built at the first call: most maps never get that far. Not safe from several threads at once.
  const RegistrationTarget& target();

 private:
  const LoopProblem& problem_;
  LoopPatch patch_;
  CorrelativeGrid grid_;
  std::optional<RegistrationTarget> target_;
};

/// Searches the query in the map and judges the best match.
LoopCandidate examine_loop(const LoopProblem& problem, std::span<const PlanarScan> scans,
                           LoopMap& map, const LoopPatch& query, const LoopProposal& proposal);

}  // namespace hmt::submap
