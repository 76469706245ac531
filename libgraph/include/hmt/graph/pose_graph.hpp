// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/graph/pose.hpp"

namespace hmt::graph {

/// One relative pose between two nodes with its information matrix.
struct PoseGraphEdge {
  int from = 0;
  int to = 0;
  Pose T_from_to;
  /// Inverse covariance of T_from_to in the tangent of Pose (x, y, z, rx, ry, rz; frame `to`). In
  /// Space::se2 only the rows and columns x, y and rz are used.
  Matrix6d information = Matrix6d::Identity();
};

/// Poses T_world_node and the relative poses between them. Nodes are 0..n-1.
struct PoseGraph {
  Space space = Space::se2;
  std::vector<Pose> poses;
  std::vector<PoseGraphEdge> edges;
  /// Nodes that are held at their pose. Each connected component without one holds its smallest
  /// node.
  std::vector<int> fixed;
};

}  // namespace hmt::graph
