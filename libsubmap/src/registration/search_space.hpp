// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/submap/registration/register_surface.hpp"

namespace hmt::submap {

/// A pose where a cloud may stand on a map.
struct SpaceMatch {
  Pose T_map_robot;
  double met_share = 0;  ///< of its surfaces, see met_share
};

/// Share of a cloud's surfaces that meet the map, in [0, 1]. Each direction of the normals counts
/// alike: a street is mostly ground, which fits wherever the robot stands, so what tells places
/// apart are the few points on walls.
double met_share(const Surface& source, const RegistrationTarget& map, const Pose& T_map_robot);

/// Poses of a cloud around some guesses, which may be off by a metre or two and by half a right
/// angle: every guess, turned and tilted by steps that registration can bridge, is registered with
/// a part of the points on a coarse map. Up to three that differ by more than 0.3 m or 0.1 rad,
/// best first. To be refined by register_surface.
std::vector<SpaceMatch> search_space(const Surface& source, const RegistrationTarget& map,
                                     std::span<const Pose> T_map_robot_guesses);

}  // namespace hmt::submap
