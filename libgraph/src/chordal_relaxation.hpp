// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// Poses from two linear least squares problems, whatever the poses of the nodes that are not held
/// [Carlone 2015, "Initialization techniques for 3D SLAM", Sec. III-B; Martinec 2007]:
///
///   rotations     min sum kappa_ij |R_j - R_i R_ij|_F^2 over real d x d matrices R, held ones
///   known,
///                 then the nearest rotation of each;
///   translations  min sum tau_ij |t_j - t_i - R_i t_ij|^2 with those rotations.
///
/// kappa and tau are the mean information of the edge in rotation and in translation. Nothing where
/// an edge set without information leaves a rotation or a translation open.
std::optional<std::vector<Pose>> chordal_poses(const PoseGraph& graph);

}  // namespace hmt::graph
