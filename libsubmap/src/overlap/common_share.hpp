// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/overlap/overlap.hpp"

namespace hmt::submap {

/// Throws InputError naming the option that is out of its range.
void check(const OverlapOptions& options);
/// Throws InputError where a number of the pose is not finite.
void check_finite(const Pose& pose);

/// |a intersection b| / |a union b| [Blanco 2009, Eq. 13] of readings of so many points, matches
/// counted in both directions and averaged; 0 if one is empty.
double sensed_space_overlap(int size_a, int size_b, int matches_a, int matches_b);

}  // namespace hmt::submap
