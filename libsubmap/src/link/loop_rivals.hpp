// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "hmt/submap/link/loop_search.hpp"

namespace hmt::submap {

/// A match is unique only if no other map tells another place for the same keyframe: of two
/// accepted candidates with the same b that contradict each other, beyond the accumulated
/// covariance between their maps, the weaker one becomes ambiguous, or both if their scores are
/// close.
void refuse_rivals(const LoopProblem& problem, std::span<LoopCandidate> candidates);

}  // namespace hmt::submap
