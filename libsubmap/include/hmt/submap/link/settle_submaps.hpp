// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/submap/local/submap.hpp"
#include "hmt/submap/registration/constraint.hpp"

namespace hmt::submap {

/// T_world_keyframe of all keyframes by submaps: each as its submap has it, placed by the submap's
/// pose, then bent to its neighbors: one submap after the other is optimized with its neighbors, by
/// the constraints inside and across their borders, while all others stand still; then all are
/// shifted as they are, rigid, and bent again. What the condensed links cannot carry, a submap that
/// gives way within, is settled so without ever solving more than one neighborhood at once. Ordered
/// by id, so the same for any number of threads.
std::vector<Pose> settle_submaps(Space space, std::span<const Submap> submaps,
                                 std::span<const Pose> T_world_submap,
                                 std::span<const Constraint> constraints);

}  // namespace hmt::submap
