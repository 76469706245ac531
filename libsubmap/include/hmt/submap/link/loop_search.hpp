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
  outlier,       ///< refused by the robust optimizer
  rejected,      ///< refused by the user, or it tells the same as one that the user refused
  confirmed      ///< accepted by the user, whatever speaks against it
};

/// Whether the candidate holds the map together.
inline bool is_closure(LoopVerdict verdict) {
  return verdict == LoopVerdict::accepted || verdict == LoopVerdict::confirmed;
}

/// A pair of keyframes that may show the same place, with everything the verdict rests on.
struct LoopCandidate {
  int a = 0;  ///< keyframe whose neighborhood is the map; a < b
  int b = 0;  ///< keyframe that is searched in it
  int submap_a = 0;
  int submap_b = 0;
  /// Why it was looked at: so far from each other by the map as it was then, known so well.
  double predicted_distance_m = 0;
  double predicted_sigma_m = 0;  ///< of the relative position, root of the trace
  Pose T_a_b;                    ///< best match; where there is none, the prediction
  /// Of T_a_b, tangent of Pose (frame b); zero without a match, that of the search grid where
  /// registration did not confirm it.
  Matrix6d information = Matrix6d::Zero();
  double score = 0;  ///< share of b's points that meet a's surfaces at the best match, [0, 1]
  double second_score = 0;     ///< the same of the best match that differs from the best one, or
                               ///< 0.7 score if it is below that
  double inlier_fraction = 0;  ///< of the confirming registration
  double rmse_m = 0;
  double free_space_conflict = 0;  ///< share of b's points that lie where a saw through, and the
                                   ///< reverse
  double mahalanobis = 0;  ///< distance of T_a_b from the prediction, accumulated covariance
  /// By how much it raises the least chi2 of the finished map: with it minus without it, whether it
  /// was taken or not. Zero without a match, and until the map is finished.
  double chi2_rise = 0;
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
  int first_query = 0;         ///< keyframes before this one are not searched for, only in
  double query_spacing_m = 2;  ///< travel between places that are searched for
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
/// a decimetre, are left to plain registration. A place that stands within 2 m of an earlier map,
/// looks the same way and is tied to it makes no map of its own. Verdicts that need all loops
/// together (inconsistent, outlier) are left to the caller. Ordered by (a, b); same result for any
/// number of threads. In space the upright surfaces, seen from above, are matched in the plane and
/// registration finds height and tilt; free space is not looked at, because clouds look over what
/// is in the way.
std::vector<LoopCandidate> search_loops(const LoopProblem& problem, const Run& run);

}  // namespace hmt::submap
