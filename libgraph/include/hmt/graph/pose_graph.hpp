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

/// Position of a point as measured from one node, with its information matrix.
struct PointEdge {
  int node = 0;
  int point = 0;
  Eigen::Vector3d p_node = Eigen::Vector3d::Zero();  ///< in the frame of the node
  /// Inverse covariance of p_node. In Space::se2 only the rows and columns x and y are used.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
};

/// Poses T_world_node and the relative poses between them; points in the world and their positions
/// as measured from the nodes. Nodes are 0..n-1, points 0..m-1.
struct PoseGraph {
  Space space = Space::se2;
  std::vector<Pose> poses;
  std::vector<PoseGraphEdge> edges;
  /// Nodes that are held at their pose. Each connected component without one holds its smallest
  /// node. Nodes that measure the same point are connected.
  std::vector<int> fixed;
  std::vector<Eigen::Vector3d> points;  ///< in the world; in Space::se2 their z stays as it is
  std::vector<PointEdge> point_edges;
};

}  // namespace hmt::graph
