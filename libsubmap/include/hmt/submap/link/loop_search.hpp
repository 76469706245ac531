// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/track.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// What became of a loop-closure candidate.
enum class LoopVerdict {
  accepted,
  low_score,     ///< the best match explains too little of what was seen
  ambiguous,     ///< a second, different match is nearly as good
  unconfirmed,   ///< registration did not converge, or ended elsewhere
  contradicted,  ///< free space seen by one is occupied in the other
  inconsistent,  ///< disagrees with the other loop closures (pairwise consistency)
  outlier        ///< refused by the robust optimizer
};

/// A pair of keyframes that may show the same place, with everything the verdict rests on.
struct LoopCandidate {
  int a = 0;  ///< keyframe whose neighborhood is the map; a < b
  int b = 0;  ///< keyframe that is searched in it
  int submap_a = 0;
  int submap_b = 0;
  Pose T_a_b;                               ///< best match
  Matrix6d information = Matrix6d::Zero();  ///< of T_a_b, tangent of Pose (frame b)
  double score = 0;  ///< share of b's points that meet a's surfaces at the best match, [0, 1]
  double second_score = 0;     ///< the same of the best match that differs from the best one, or
                               ///< 0.7 score if it is below that
  double inlier_fraction = 0;  ///< of the confirming registration
  double rmse_m = 0;
  double free_space_conflict = 0;  ///< share of b's points that lie where a saw through, and the
                                   ///< reverse
  double mahalanobis = 0;  ///< distance of T_a_b from the prediction, accumulated covariance
  LoopVerdict verdict = LoopVerdict::low_score;
  std::string reason;  ///< one sentence for the user

  bool operator==(const LoopCandidate&) const = default;
};

/// What the search may look at. `already_tied` and `covariance` are called from several threads at
/// once.
struct LoopProblem {
  Space space = Space::se2;
  std::span<const Keyframe> keyframes;
  std::span<const Pose> T_world_keyframe;  ///< best current estimate
  std::span<const int> submap;             ///< of each keyframe
  /// True where the two keyframes are already tied closely enough that nothing is to be learnt.
  std::function<bool(int a, int b)> already_tied;
  PairCovariance covariance;
  const ObservationStore* observations = nullptr;
};

/// Loop closures between places that may have been visited twice: pairs are proposed where the
/// predicted sensed regions meet within the accumulated covariance, matched exhaustively within it
/// (branch and bound over the local map around `a`), then confirmed by registration, by free space
/// and by the margin over the second-best match. The map is a stretch of the track around one
/// keyframe, the query a shorter one; pairs within them, and pairs whose relative pose is known to
/// a decimetre, are left to plain registration. Verdicts that need all loops together
/// (inconsistent, outlier) are left to the caller. Ordered by (a, b); same result for any number of
/// threads. Space::se2 only: in space nothing is searched and Run is told so.
std::vector<LoopCandidate> search_loops(const LoopProblem& problem, const Run& run);

}  // namespace hmt::submap
