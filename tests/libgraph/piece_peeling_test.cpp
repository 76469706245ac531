// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "piece_peeling.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hmt::graph {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

std::vector<Arc> star(int leaves) {
  std::vector<Arc> arcs;
  for (int leaf = 1; leaf <= leaves; ++leaf) arcs.push_back({0, leaf, 1});
  return arcs;
}

// `spokes` paths of two nodes on node 0.
std::vector<Arc> wheel(int spokes) {
  std::vector<Arc> arcs;
  for (int s = 0; s < spokes; ++s) {
    arcs.push_back({0, 2 * s + 1, 1});
    arcs.push_back({2 * s + 1, 2 * s + 2, 1});
  }
  return arcs;
}

// Star of 4: the association with itself is 8, 6 and 4 as leaves go, and then half has left. The
// second leaf is cut at 1 + 1 / (6 - 1).
TEST(PiecePeeling, TakesLeavesOffAStarUntilHalfOfItIsGone) {
  const SpectralCut cut{{0, 0, 0, 0, 1}, 1 + 1 / 7.0, 1, 0};
  const Peeling peeling = peel_pieces(whole_graph({5, star(4)}), cut, 1.5);
  EXPECT_THAT(peeling.part, ElementsAre(0, 2, 0, 0, 1));
  EXPECT_EQ(peeling.parts, 3);
  ASSERT_THAT(peeling.bisections, SizeIs(2));
  EXPECT_DOUBLE_EQ(peeling.bisections[0].ncut, cut.ncut);
  EXPECT_DOUBLE_EQ(peeling.bisections[1].ncut, 1.2);
  EXPECT_EQ(peeling.bisections[1].size_a, 1);
  EXPECT_EQ(peeling.bisections[1].size_b, 3);
}

TEST(PiecePeeling, KeepsWhatIsNotBelowTauAtItsTurn) {
  const SpectralCut cut{{0, 0, 0, 0, 1}, 1 + 1 / 7.0, 1, 0};
  EXPECT_EQ(peel_pieces(whole_graph({5, star(4)}), cut, 1.19).parts, 2);
}

// A spoke: cut 1, assoc 3. Association of what is left: 16, 12, 8.
TEST(PiecePeeling, TakesSpokesOffAWheelWhole) {
  const SpectralCut cut{{0, 1, 1, 0, 0, 0, 0, 0, 0}, 1 / 3.0 + 1 / 13.0, 0.3, 0};
  const Peeling peeling = peel_pieces(whole_graph({9, wheel(4)}), cut, 0.6);
  EXPECT_THAT(peeling.part, ElementsAre(0, 1, 1, 2, 2, 0, 0, 0, 0));
  EXPECT_DOUBLE_EQ(peeling.bisections[1].ncut, 1 / 3.0 + 1 / 9.0);
}

// Bisections that took an eigenvector.
int64_t solved(const PartitionResult& result) {
  return std::count_if(result.bisections.begin(), result.bisections.end(),
                       [](const Bisection& b) { return b.lambda_2 > 0; });
}

// One leaf after the other would take 4000 eigenvectors, of 4000 nodes each.
TEST(PiecePeeling, BoundsTheEigenvectorsOfAStar) {
  for (const double tau : {1.001, 1.01, 1.5, 1.99}) {
    PartitionOptions options;
    options.tau = tau;
    const PartitionResult result = recursive_partition({4001, star(4000)}, options);
    // The last leaf that goes is one of m with 1 + 1 / (2 m - 1) < tau.
    const auto stay = static_cast<int>(std::floor((1 / (tau - 1) + 1) / 2));
    EXPECT_EQ(*std::max_element(result.labels.begin(), result.labels.end()), 4000 - stay) << tau;
    EXPECT_LT(solved(result), 60) << tau;
    for (const Bisection& b : result.bisections) EXPECT_LT(b.ncut, tau);
  }
}

TEST(PiecePeeling, BoundsTheEigenvectorsOfAWheel) {
  const PartitionResult result = recursive_partition({4001, wheel(2000)}, {});
  EXPECT_GT(*std::max_element(result.labels.begin(), result.labels.end()), 1990);
  EXPECT_LT(solved(result), 60);
}

// Hubs along a path, each with 200 leaves: cut between the hubs first.
TEST(PiecePeeling, BoundsTheEigenvectorsOfACaterpillar) {
  std::vector<Arc> arcs;
  for (int hub = 0; hub < 20; ++hub) {
    if (hub > 0) arcs.push_back({hub - 1, hub, 1});
    for (int leaf = 0; leaf < 200; ++leaf) arcs.push_back({hub, 20 + hub * 200 + leaf, 1});
  }
  for (const double tau : {0.5, 1.1, 1.9}) {
    PartitionOptions options;
    options.tau = tau;
    EXPECT_LT(solved(recursive_partition({20 * 201, arcs}, options)), 20 * 50) << tau;
  }
}

}  // namespace
}  // namespace hmt::graph
