// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/submap/registration/register_surface.hpp"

namespace hmt::submap {

/// Where a pose may lie around a guess: in the plane and in heading; height and tilt are those of
/// the guess.
struct CorrelativeWindow {
  double half_width_m = 1.0;
  double half_angle_rad = 0.5;
};

/// One of the best poses found.
struct CorrelativeMatch {
  Pose T_target_source;
  /// Mean over the source's points of exp(-d^2 / (2 s^2)), d the distance in the plane to the
  /// target, s 0.1 m; in [0, 1].
  double score = 0;
};

/// Exhaustive search of a source on a target seen from above, coarse to fine [Olson 2009]: every
/// pose of a 5 cm grid in the window, bounded from above by pooled cells. Returns up to
/// `max_matches` poses that differ by more than 0.3 m or 0.1 rad, best first; nothing if either
/// side is empty. What scores less than `least_score` may be left out, which saves most of the time
/// where nothing fits; if the best one scores that much, nothing is left out within 0.7 of it. To
/// be refined by register_surface.
std::vector<CorrelativeMatch> correlative_search(const Surface& source,
                                                 const RegistrationTarget& target,
                                                 const Pose& T_target_source_guess,
                                                 const CorrelativeWindow& window, int max_matches,
                                                 double least_score = 0);

}  // namespace hmt::submap
