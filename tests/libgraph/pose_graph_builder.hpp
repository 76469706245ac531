// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
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

/// A drive around a sphere of 10 m in `rings` turns of `per_ring` poses, each joined to the one
/// below it; noise in metres and radians. The poses are those of the noisy chain.
inline PoseGraph noisy_sphere(int rings, int per_ring, double noise, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, noise);
  const int count = rings * per_ring;
  std::vector<Pose> truth;
  for (int i = 0; i < count; ++i) {
    const double azimuth = 2 * 3.14159265358979 * i / per_ring;
    const double elevation = 1.4 * (2.0 * i / count - 1);
    const Eigen::Vector3d ahead(-std::sin(azimuth), std::cos(azimuth), 0);
    const Eigen::Vector3d up(std::cos(elevation) * std::cos(azimuth),
                             std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    Eigen::Matrix3d R;
    R << ahead, up.cross(ahead), up;
    truth.push_back({10 * up, Eigen::Quaterniond(R)});
  }
  PoseGraph graph;
  graph.space = Space::se3;
  const auto measure = [&](int a, int b) {
    Vector6d step;
    for (double& value : step) value = normal(generator);
    const Pose T = relative_pose(truth[static_cast<size_t>(a)], truth[static_cast<size_t>(b)]);
    graph.edges.push_back(edge(a, b, boxplus(T, step), 1 / (noise * noise)));
  };
  for (int i = 1; i < count; ++i) measure(i - 1, i);
  for (int i = per_ring; i < count; ++i) measure(i - per_ring, i);
  graph.poses.push_back(truth[0]);
  for (int i = 1; i < count; ++i)
    graph.poses.push_back(graph.poses.back() * graph.edges[static_cast<size_t>(i) - 1].T_from_to);
  return graph;
}

}  // namespace hmt::graph::test
