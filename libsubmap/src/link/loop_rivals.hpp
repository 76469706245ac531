// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "hmt/submap/link/loop_search.hpp"

namespace hmt::submap {

/// A match is unique only if no other map tells another place for the same keyframe: an accepted
/// candidate becomes ambiguous where another match of the same b, accepted or not, contradicts it
/// beyond the accumulated covariance between the two maps and explains nearly as much. Scores on
/// different maps are not strictly comparable, so of two rivals usually neither stays.
void refuse_rivals(const LoopProblem& problem, std::span<LoopCandidate> candidates);

}  // namespace hmt::submap
