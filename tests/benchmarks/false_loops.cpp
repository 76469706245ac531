// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

namespace hmt::benchmarks {
namespace {

using graph::Pose;

double uniform(std::mt19937& generator, double low, double high) {
  return low + (high - low) * static_cast<double>(generator()) / 4294967296.0;
}

int uniform_node(std::mt19937& generator, size_t count) {
  return static_cast<int>(generator() % count);
}

/// Normal deviate by Box and Muller, the same in every standard library.
double normal(std::mt19937& generator) {
  const double radius = std::sqrt(-2 * std::log(1 - uniform(generator, 0, 1)));
  return radius * std::cos(2 * std::numbers::pi * uniform(generator, 0, 1));
}

/// Relative pose of 0.3 m and 10 deg (standard deviations).
Pose small_relative_pose(graph::Space space, std::mt19937& generator) {
  constexpr double kTurn = 10 * std::numbers::pi / 180;
  graph::Vector6d step;
  for (int k = 0; k < 6; ++k) step[k] = (k < 3 ? 0.3 : kTurn) * normal(generator);
  if (space == graph::Space::se2) return Pose::planar(step[0], step[1], step[5]);
  return boxplus(Pose{}, step);
}

/// Relative pose within the box of all poses and with any rotation.
Pose random_relative_pose(const graph::PoseGraph& graph, std::mt19937& generator) {
  Eigen::AlignedBox3d box;
  for (const Pose& pose : graph.poses) box.extend(pose.translation);
  const double reach = box.diagonal().norm() / 2;
  const double pi = std::numbers::pi;
  const auto coordinate = [&] { return uniform(generator, -reach, reach); };
  const double x = coordinate();
  const double y = coordinate();
  if (graph.space == graph::Space::se2) return Pose::planar(x, y, uniform(generator, -pi, pi));
  const double z = coordinate();
  Eigen::Quaterniond q;
  for (double& value : q.coeffs()) value = uniform(generator, -1, 1);
  return {{x, y, z}, q.normalized()};
}

}  // namespace

CorruptedGraph add_false_loops(const graph::PoseGraph& clean, double share, int group_size,
                               FalsePose kind, unsigned seed) {
  std::mt19937 generator(seed);
  CorruptedGraph corrupted{clean, {}, std::vector<bool>(clean.edges.size(), false), {}};
  corrupted.place.resize(clean.poses.size());
  std::iota(corrupted.place.begin(), corrupted.place.end(), 0);
  std::vector<size_t> loops;
  for (size_t k = 0; k < clean.edges.size(); ++k) {
    corrupted.is_loop.push_back(std::abs(clean.edges[k].to - clean.edges[k].from) != 1);
    if (corrupted.is_loop[k]) loops.push_back(k);
  }
  for (size_t k = loops.size(); k > 1; --k) std::swap(loops[k - 1], loops[generator() % k]);
  loops.resize(static_cast<size_t>(std::llround(share * static_cast<double>(loops.size()))));
  const size_t nodes = clean.poses.size();
  int from = 0;
  int to = 0;
  Pose T_world_false;
  for (size_t i = 0; i < loops.size(); ++i) {
    const int step = static_cast<int>(i) % group_size;
    if (step == 0) {
      do {
        from = uniform_node(generator, nodes - static_cast<size_t>(group_size));
        to = uniform_node(generator, nodes - static_cast<size_t>(group_size));
      } while (std::abs(from - to) <= 2 * group_size);
      // Where the stretch at `to` lies in the false world, which holds for the whole group.
      const Pose T_from_to = kind == FalsePose::anywhere
                                 ? random_relative_pose(clean, generator)
                                 : small_relative_pose(clean.space, generator);
      T_world_false = clean.poses[static_cast<size_t>(from)] * T_from_to *
                      clean.poses[static_cast<size_t>(to)].inverse();
    }
    graph::PoseGraphEdge& edge = corrupted.graph.edges[loops[i]];
    edge.from = from + step;
    edge.to = to + step;
    edge.T_from_to = relative_pose(clean.poses[static_cast<size_t>(edge.from)],
                                   T_world_false * clean.poses[static_cast<size_t>(edge.to)]);
    corrupted.is_false[loops[i]] = true;
  }
  return corrupted;
}

CorruptedGraph cut_into_sessions(CorruptedGraph corrupted, int sessions) {
  const auto nodes = static_cast<int>(corrupted.graph.poses.size());
  CorruptedGraph cut{corrupted.graph, {}, {}, corrupted.place};
  cut.graph.edges.clear();
  for (size_t k = 0; k < corrupted.graph.edges.size(); ++k) {
    const graph::PoseGraphEdge& edge = corrupted.graph.edges[k];
    const int i = std::max(edge.from, edge.to);
    if (!corrupted.is_loop[k] && i * sessions / nodes != (i - 1) * sessions / nodes) continue;
    cut.graph.edges.push_back(edge);
    cut.is_loop.push_back(corrupted.is_loop[k]);
    cut.is_false.push_back(corrupted.is_false[k]);
  }
  return cut;
}

CorruptedGraph shuffle_nodes(CorruptedGraph corrupted, unsigned seed) {
  std::mt19937 generator(seed);
  graph::PoseGraph& graph = corrupted.graph;
  std::vector<int>& place = corrupted.place;
  for (size_t k = place.size(); k > 1; --k) std::swap(place[k - 1], place[generator() % k]);
  std::vector<Pose> poses(place.size());
  for (size_t k = 0; k < place.size(); ++k) poses[static_cast<size_t>(place[k])] = graph.poses[k];
  graph.poses = std::move(poses);
  for (graph::PoseGraphEdge& edge : graph.edges) {
    edge.from = place[static_cast<size_t>(edge.from)];
    edge.to = place[static_cast<size_t>(edge.to)];
  }
  for (int& node : graph.fixed) node = place[static_cast<size_t>(node)];
  return corrupted;
}

}  // namespace hmt::benchmarks
