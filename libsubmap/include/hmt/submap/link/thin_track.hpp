// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/submap/link/loop_search.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// Which keyframes stay when others hang on them: host[k] is k itself for one that stays, else the
/// one that the observations of k hang on from then on, which stays. Keyframes beyond the end of
/// `host` stay.
using Hosts = std::span<const int>;

/// Number of each keyframe among those that stay; -1 for the others.
std::vector<int> numbers_of_kept(Hosts host, size_t num_keyframes);

/// The track with the keyframes that stay. Every observation keeps its place in the world: that of
/// its keyframe at `T_world_keyframe`, one pose for each entry of `host`. Odometry between two that
/// stay is that of the chain between them, with its covariance; the first and the last entry of
/// `host` must stay.
Track thin_track(const Track& track, Hosts host, std::span<const Pose> T_world_keyframe);

/// The constraints between those that stay, by their new numbers: the odometry is that of `thinned`
/// between the first `num_kept` keyframes, the others are kept as they are. What tied the keyframes
/// that went to the map placed their observations; no constraint is made of it, so that nothing is
/// counted twice.
std::vector<Constraint> thin_constraints(std::span<const Constraint> constraints,
                                         std::span<const int> number, const Track& thinned,
                                         size_t num_kept);

/// The candidates between those that stay, by their new numbers.
std::vector<LoopCandidate> thin_loops(std::span<const LoopCandidate> loops,
                                      std::span<const int> number);

}  // namespace hmt::submap
