// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/registration/register_surface.hpp"

namespace hmt::submap {

/// Share of the target's surfaces in the view of a planar source that the source, placed at
/// T_target_source, would have seen through: it measured well behind them in their direction. In
/// [0, 1]; 0 if none is in view. What the source newly sees does not count, so a view into an
/// unknown room contradicts nothing.
double seen_through_share(const Surface& source, const RegistrationTarget& target,
                          const Pose& T_target_source);

}  // namespace hmt::submap
