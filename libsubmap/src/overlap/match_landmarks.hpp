// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "pose_spread.hpp"
#include "sensed_landmarks.hpp"

namespace hmt::submap {

/// Number of landmarks that both readings sensed. The same name is the same landmark, two names are
/// two. Where one has no name the position decides: epsilon^T S^-1 epsilon <= d^2 with epsilon the
/// difference of the two positions [Blanco 2009, Eq. 15] and S the sum of the spread of the pose
/// and both measurement covariances; descriptors of equal length must not be of two landmarks
/// either. One to one, the smallest distance first, ties by index. The spread is linearized half
/// way between the two positions, so the result is the same with a and b exchanged.
int match_landmarks(const SensedLandmarks& a, const SensedLandmarks& b, const PoseSpread& spread,
                    const OverlapOptions& options);

}  // namespace hmt::submap
