// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "hmt/submap/registration/register_surface.hpp"

namespace hmt::submap {

/// Share of the target's surfaces in the view of a planar source that the source, placed at
/// T_target_source, would have seen through: it measured well behind them in their direction. In
/// [0, 1]; 0 if none is in view. What the source newly sees does not count, so a view into an
/// unknown room contradicts nothing.
double seen_through_share(const Surface& source, const RegistrationTarget& target,
                          const Pose& T_target_source);

/// Share of the points of a planar source, placed at T_target_source, that stand where one of the
/// placed surfaces saw something farther off: they are new there, moved, or the pose is wrong. What
/// stands behind all that was seen, or out of view, does not count. In [0, 1].
double standing_in_view_share(const Surface& source,
                              std::span<const RegistrationTarget::Placed> target,
                              const Pose& T_target_source);

}  // namespace hmt::submap
