// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "landmark_filter.hpp"

namespace hmt::submap {

/// What a measurement is taken for.
constexpr int kNewLandmark = -1;  ///< none that the filter holds
constexpr int kLeftOut = -2;      ///< ambiguous: nothing is learnt from it

/// Landmark of each measurement of one reading, for measurements without names: the one within a
/// Mahalanobis distance of 3 [Blanco 2009, Eq. 15], one to one. Left out where a second one lies
/// within that distance too, where two measurements claim the same one, and where the nearest is
/// neither near nor far enough to be another.
std::vector<int> associate_landmarks(const LandmarkFilter& filter,
                                     std::span<const MeasuredLandmark> measured);

}  // namespace hmt::submap
