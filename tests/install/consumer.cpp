// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <hmt/graph/pose.hpp>
#include <hmt/graph/pose_optimizer.hpp>
#include <hmt/submap/log/log_reader.hpp>
#include <iostream>

// Uses each library where it needs its own dependencies; 0 if the answers are right.
int main() {
  using hmt::graph::Pose;

  // One edge of 2 m between two nodes that start 1 m apart.
  hmt::graph::PoseGraph graph;
  graph.poses = {Pose::planar(0, 0, 0), Pose::planar(1, 0, 0)};
  hmt::graph::PoseGraphEdge edge;
  edge.from = 0;
  edge.to = 1;
  edge.T_from_to = Pose::planar(2, 0, 0);
  graph.edges = {edge};
  const auto result = hmt::graph::optimize(graph, {});
  const Pose T_0_1 = hmt::graph::relative_pose(result.poses[0], result.poses[1]);
  if (std::abs(T_0_1.translation.x() - 2) > 1e-6) {
    std::cerr << "expected 2 m, got " << T_0_1.translation.x() << "\n";
    return 1;
  }

  try {
    hmt::submap::open_log("/nonexistent");
  } catch (const hmt::graph::InputError& error) {
    std::cout << "consumer: as expected: " << error.what() << "\n";
    return 0;
  }
  std::cerr << "a missing log was opened\n";
  return 1;
}
