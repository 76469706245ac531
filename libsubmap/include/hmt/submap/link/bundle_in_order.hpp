// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/submap/registration/sighting.hpp"
#include "hmt/submap/registration/track.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// T_world_keyframe by odometry and sightings of landmarks, robustly (Huber): all keyframes so far
/// are optimized together again and again while the track grows, because a landmark that is seen
/// again after a long way corrects a drift from which an optimization of the whole log at once
/// would not find back. Each time the track has grown by a twentieth, so the cost is that of a
/// fixed number of optimizations of the whole log, times the logarithm of its length.
std::vector<Pose> bundle_in_order(const Track& track, std::span<const Sighting> sightings,
                                  const Run& run);

}  // namespace hmt::submap
