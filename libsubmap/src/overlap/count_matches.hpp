// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/overlap/overlap.hpp"
#include "nearest_grid.hpp"
#include "pose_spread.hpp"
#include "sensed_points.hpp"

namespace hmt::submap {

/// Number of `queries` whose nearest counterpart among `targets` is within the gate, that is, which
/// have any counterpart within it: epsilon^T S^-1 epsilon <= d^2 with epsilon the difference of the
/// two points [Blanco 2009, Eq. 15] and S the sum of the spread of the pose at the query and of
/// both points' own covariances [Eq. 16]. Queries where the pose alone is too uncertain do not
/// match. Everything in one common frame. `grid`, of the targets, makes it faster but changes no
/// result; without it only the tree is used.
int count_matches(const SensedPoints& queries, const SensedPoints& targets,
                  const PoseSpread& spread, const OverlapOptions& options,
                  const NearestGrid* grid = nullptr);

}  // namespace hmt::submap
