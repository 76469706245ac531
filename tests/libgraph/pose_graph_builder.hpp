// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph::test {

inline PoseGraphEdge edge(int from, int to, const Pose& T_from_to, double information = 1) {
  return {from, to, T_from_to, information * Matrix6d::Identity()};
}

/// Pose in space drawn around `center`; the rotation by up to about one radian.
inline Pose random_pose(std::mt19937& generator, const Eigen::Vector3d& center, double spread) {
  std::normal_distribution<double> normal;
  Vector6d step;
  for (int k = 0; k < 6; ++k) step[k] = spread * normal(generator);
  return boxplus(Pose{center, Eigen::Quaterniond::Identity()}, step);
}

/// Positive definite information with correlations.
inline Matrix6d random_information(std::mt19937& generator) {
  std::normal_distribution<double> normal;
  Matrix6d A;
  for (int k = 0; k < 36; ++k) A(k / 6, k % 6) = normal(generator);
  return A * A.transpose() + Matrix6d::Identity();
}

/// Chain 0 - 1 - ... of unit steps along x with noisy measurements and a loop from every
/// `stride`-th node back by `stride`; the poses are those of the noisy chain.
inline PoseGraph noisy_graph(Space space, int num_nodes, int stride, double noise, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, noise);
  const auto perturb = [&](const Pose& T) {
    Vector6d step = Vector6d::Zero();
    for (const int k : {0, 1, 5}) step[k] = normal(generator);
    if (space == Space::se3)
      for (const int k : {2, 3, 4}) step[k] = normal(generator);
    return boxplus(T, step);
  };
  PoseGraph graph;
  graph.space = space;
  std::vector<Pose> truth;
  for (int i = 0; i < num_nodes; ++i) truth.push_back(Pose::planar(i, 0.3 * (i % 3), 0.2 * i));
  const auto measure = [&](int a, int b) {
    const Pose T_a_b = relative_pose(truth[static_cast<size_t>(a)], truth[static_cast<size_t>(b)]);
    graph.edges.push_back(edge(a, b, perturb(T_a_b), 1 / (noise * noise)));
  };
  for (int i = 0; i + 1 < num_nodes; ++i) measure(i, i + 1);
  for (int i = stride; i < num_nodes; i += stride) measure(i, i - stride);
  graph.poses.push_back(truth[0]);
  for (int i = 0; i + 1 < num_nodes; ++i)
    graph.poses.push_back(graph.poses.back() * graph.edges[static_cast<size_t>(i)].T_from_to);
  return graph;
}

}  // namespace hmt::graph::test
