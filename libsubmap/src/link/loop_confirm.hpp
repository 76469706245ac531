// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "loop_surfaces.hpp"

namespace hmt::submap {

/// What registration makes of a match of two patches.
struct LoopConfirmation {
  int a = 0;   ///< the keyframe of the map that stands nearest to the query's center
  Pose T_a_b;  ///< b: the query's center
  Matrix6d information = Matrix6d::Zero();
  double inlier_fraction = 0;
  double rmse_m = 0;
  std::string objection;  ///< why it is not confirmed; empty if it is
};

/// Registers the whole query onto the whole map from the match, then what both saw close to b onto
/// each other, both ways: the first shows whether the two patches agree, the second is free of the
/// drift within them. The second's result counts where it exists, with the first as its prior. The
/// covariance has the drift of the keyframes that were registered against the two that it is told
/// for.
class LoopConfirmer {
 public:
  LoopConfirmer(const LoopProblem& problem, const LoopPatch& map) : problem_(problem), map_(map) {}

  /// `T_map_query` is between the centers. Not safe from several threads at once.
  LoopConfirmation confirm(const LoopPatch& query, const Pose& T_map_query);

 private:
  void load_map();
  /// Adds to the covariance what the drift within the patches leaves open.
  void widen_by_drift(const LoopPatch& query, size_t index, LoopConfirmation& confirmation) const;

  const LoopProblem& problem_;
  const LoopPatch& map_;
  PatchSurfaces map_surfaces_;  ///< loaded at the first call: most maps never get that far
  std::optional<RegistrationTarget> map_target_;
};

}  // namespace hmt::submap
