// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/graph/pose_optimizer.hpp"

namespace hmt::graph {

/// One start of the optimization.
struct Start {
  Initialization kind = Initialization::given;
  std::vector<Pose> poses;
  std::vector<Eigen::Vector3d> points;
  double chi2 = 0;  ///< over all edges
};

/// Where the point edges see the points from the given poses: their mean weighted by information; a
/// point that they leave open stays where the graph has it.
std::vector<Eigen::Vector3d> place_points(const PoseGraph& graph, const std::vector<Pose>& poses);

/// The start that optimize() takes for `wanted`. A chordal relaxation that does not exist, because
/// edges without information leave a pose open, gives way to the poses of the graph. Throws
/// InputError like optimize().
Start initial_poses(const PoseGraph& graph, Initialization wanted);

}  // namespace hmt::graph
