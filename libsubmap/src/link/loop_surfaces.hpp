// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/submap/registration/register_surface.hpp"
#include "loop_patch.hpp"

namespace hmt::submap {

/// What the keyframes of a patch saw, for registration: one entry a keyframe.
struct PatchSurfaces {
  std::vector<Pose> T_center_keyframe;
  std::vector<Surface> surfaces;
};

PatchSurfaces load_surfaces(const LoopProblem& problem, const LoopPatch& patch);

/// The keyframes within `reach_m` of a place, in the frame of that place.
PatchSurfaces surfaces_around(const PatchSurfaces& patch, const Pose& T_center_place,
                              double reach_m);

/// The points within `range_m` of the center, in its frame, every n-th, so that there are at most
/// `most_points`.
Surface merged_surface(const PatchSurfaces& patch, double range_m, size_t most_points);

RegistrationTarget make_target(const PatchSurfaces& patch);

}  // namespace hmt::submap
