// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pairwise_consistency.hpp"

#include <gtest/gtest.h>

#include <random>

#include "hmt/graph/input_error.hpp"
#include "maximum_clique.hpp"
#include "pose_graph_builder.hpp"

namespace hmt::graph {
namespace {

using test::edge;

// 0 --- 1 --- ... --- 9: ten unit steps, well known
PoseGraph line(Space space) {
  PoseGraph graph;
  graph.space = space;
  for (int i = 0; i < 10; ++i) graph.poses.push_back(Pose::planar(i, 0, 0));
  for (int i = 0; i < 9; ++i) graph.edges.push_back(edge(i, i + 1, Pose::planar(1, 0, 0), 1e4));
  return graph;
}

TEST(PairwiseConsistentSet, KeepsTheLargestGroupThatAgrees) {
  for (const Space space : {Space::se2, Space::se3}) {
    // Three loops claim that the line turned back one metre to the left; two others that it did
    // so three metres ahead.
    const std::vector<PoseGraphEdge> loops = {
        edge(9, 0, Pose::planar(-6, 0, 0), 1e3), edge(9, 1, Pose::planar(-8, 1, 0), 1e3),
        edge(8, 0, Pose::planar(-5, 0, 0), 1e3), edge(8, 1, Pose::planar(-7, 1, 0), 1e3),
        edge(9, 2, Pose::planar(-7, 1, 0), 1e3)};
    const std::vector<bool> expected = {false, true, false, true, true};
    EXPECT_EQ(pairwise_consistent_set(line(space), loops), expected);
  }
}

TEST(PairwiseConsistentSet, WidensWithTheUncertaintyOfTheTrajectory) {
  // The two loops differ by 0.3 m over a trajectory of nine edges each way.
  const std::vector<PoseGraphEdge> loops = {edge(9, 0, Pose::planar(-9, 0, 0), 1e4),
                                            edge(0, 9, Pose::planar(9.3, 0, 0), 1e4)};
  PoseGraph trajectory = line(Space::se2);
  EXPECT_EQ(pairwise_consistent_set(trajectory, loops), (std::vector<bool>{true, false}));
  for (PoseGraphEdge& e : trajectory.edges) e.information *= 1e-2;
  EXPECT_EQ(pairwise_consistent_set(trajectory, loops), (std::vector<bool>{true, true}));
}

TEST(PairwiseConsistentSet, OfNoLoopsIsEmpty) {
  EXPECT_TRUE(pairwise_consistent_set(line(Space::se2), {}).empty());
}

TEST(PairwiseConsistentSet, RefusesALoopOutsideTheTrajectory) {
  const std::vector<PoseGraphEdge> loops = {edge(0, 10, Pose{})};
  EXPECT_THROW(pairwise_consistent_set(line(Space::se2), loops), InputError);
}

TEST(PairwiseConsistentSet, RefusesALoopOfSingularInformation) {
  std::vector<PoseGraphEdge> loops = {edge(0, 9, Pose{})};
  loops[0].information(5, 5) = 0;
  EXPECT_THROW(pairwise_consistent_set(line(Space::se2), loops), InputError);
}

std::vector<std::vector<bool>> adjacency(size_t size, std::vector<std::pair<int, int>> arcs) {
  std::vector<std::vector<bool>> adjacent(size, std::vector<bool>(size, false));
  for (const auto& [a, b] : arcs)
    adjacent[static_cast<size_t>(a)][static_cast<size_t>(b)] =
        adjacent[static_cast<size_t>(b)][static_cast<size_t>(a)] = true;
  return adjacent;
}

TEST(MaximumClique, TakesTheSmallerIndicesAmongEquals) {
  // Two triangles 0-4-5 and 1-2-3, joined by 3-4.
  const auto adjacent = adjacency(6, {{1, 2}, {2, 3}, {1, 3}, {0, 4}, {4, 5}, {0, 5}, {3, 4}});
  EXPECT_EQ(maximum_clique(adjacent), (std::vector<int>{0, 4, 5}));
  EXPECT_EQ(maximum_clique(adjacency(3, {})), (std::vector<int>{0}));
  EXPECT_TRUE(maximum_clique({}).empty());
}

/// Largest clique among all subsets of at most 16 nodes.
size_t clique_number(const std::vector<std::vector<bool>>& adjacent) {
  size_t best = 0;
  for (unsigned set = 1; set < 1u << adjacent.size(); ++set) {
    std::vector<size_t> nodes;
    for (size_t i = 0; i < adjacent.size(); ++i)
      if ((set >> i & 1) != 0) nodes.push_back(i);
    bool clique = true;
    for (const size_t a : nodes)
      for (const size_t b : nodes) clique = clique && (a == b || adjacent[a][b]);
    if (clique) best = std::max(best, nodes.size());
  }
  return best;
}

TEST(MaximumClique, EqualsExhaustiveSearchOnRandomGraphs) {
  std::mt19937 generator(3);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<std::pair<int, int>> arcs;
    for (int a = 0; a < 12; ++a)
      for (int b = 0; b < a; ++b)
        if (generator() % 10 < 6) arcs.emplace_back(a, b);
    const auto adjacent = adjacency(12, arcs);
    EXPECT_EQ(maximum_clique(adjacent).size(), clique_number(adjacent));
  }
}

}  // namespace
}  // namespace hmt::graph
