// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/partition/submap_partition.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hmt::submap {
namespace {

Constraint tie(int a, int b) {
  Constraint c;
  c.a = a;
  c.b = b;
  c.information = Matrix6d::Identity();
  return c;
}

std::vector<Constraint> chain(int n) {
  std::vector<Constraint> constraints;
  for (int i = 0; i + 1 < n; ++i) constraints.push_back(tie(i, i + 1));
  return constraints;
}

/// Two cliques of `size` nodes, 0.. and size.., joined by one weak arc between their neighbors.
graph::WeightedGraph two_rooms(int size) {
  std::vector<graph::Arc> arcs;
  for (int room = 0; room < 2; ++room)
    for (int i = 0; i < size; ++i)
      for (int j = i + 1; j < size; ++j) arcs.push_back({room * size + i, room * size + j, 0.8});
  arcs.push_back({size - 1, size, 0.05});
  return {2 * size, arcs};
}

TEST(SubmapPartition, SeparatesTwoRoomsJoinedByAWeakOverlap) {
  const graph::Labels labels = partition_keyframes(Space::se2, two_rooms(8), chain(16), {}, {}, 1);
  EXPECT_EQ(labels, (graph::Labels{0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1}));
}

TEST(SubmapPartition, JoinsAKeyframeWithoutOverlapToTheSubmapItIsTiedTo) {
  //  room of 0..7, then keyframe 8 that saw nothing and hangs on 7 by odometry alone.
  std::vector<graph::Arc> arcs;
  for (int i = 0; i < 8; ++i)
    for (int j = i + 1; j < 8; ++j) arcs.push_back({i, j, 0.8});
  EXPECT_EQ(partition_keyframes(Space::se2, {9, arcs}, chain(9), {}, {}, 1), graph::Labels(9, 0));
}

TEST(SubmapPartition, SplitsAGroupThatNoConstraintTiesTogether) {
  // One clique of overlap, but the constraints know two chains 0..3 and 4..7.
  std::vector<graph::Arc> arcs;
  for (int i = 0; i < 8; ++i)
    for (int j = i + 1; j < 8; ++j) arcs.push_back({i, j, 0.8});
  const std::vector<Constraint> constraints = {tie(0, 1), tie(1, 2), tie(2, 3),
                                               tie(4, 5), tie(5, 6), tie(6, 7)};
  EXPECT_EQ(partition_keyframes(Space::se2, {8, arcs}, constraints, {}, {}, 1),
            (graph::Labels{0, 0, 0, 0, 1, 1, 1, 1}));
}

TEST(SubmapPartition, SplitsAGroupThatOnlyALooseConstraintTiesTogether) {
  // One clique of overlap; between the chains 0..3 and 4..7 only a corridor: free along x.
  std::vector<graph::Arc> arcs;
  for (int i = 0; i < 8; ++i)
    for (int j = i + 1; j < 8; ++j) arcs.push_back({i, j, 0.8});
  std::vector<Constraint> constraints = chain(8);
  constraints[3].information(0, 0) = 0;
  EXPECT_EQ(partition_keyframes(Space::se2, {8, arcs}, constraints, {}, {}, 1),
            (graph::Labels{0, 0, 0, 0, 1, 1, 1, 1}));
}

TEST(SubmapPartition, OfNoKeyframesIsEmpty) {
  EXPECT_TRUE(partition_keyframes(Space::se2, graph::WeightedGraph(0, {}), {}, {}, {}, 1).empty());
}

}  // namespace
}  // namespace hmt::submap
