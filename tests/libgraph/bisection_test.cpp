// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bisection.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "fiedler.hpp"

namespace hmt::graph {
namespace {

using testing::ElementsAre;

// A connected graph: a random tree with random arcs besides.
CsrGraph random_graph(int nodes, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> weight(0.01, 1);
  std::vector<Arc> arcs;
  for (int a = 1; a < nodes; ++a) {
    const auto parent = static_cast<int>(random() % static_cast<unsigned>(a));
    for (int b = 0; b < a; ++b)
      if (b == parent || weight(random) < 0.1) arcs.push_back({a, b, weight(random)});
  }
  return whole_graph({nodes, arcs});
}

std::vector<double> fiedler_vector(const CsrGraph& graph) {
  const FiedlerPairs pairs = FiedlerSolver(graph).pairs(1);
  std::vector<double> y;
  for (int i = 0; i < graph.size(); ++i)
    y.push_back(pairs.z(i, 0) / std::sqrt(graph.degrees[static_cast<size_t>(i)]));
  return y;
}

// Every way to cut the nodes in two along `y`.
std::vector<Sides> all_thresholds(const std::vector<double>& y) {
  std::vector<size_t> order(y.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&y](size_t a, size_t b) { return y[a] < y[b]; });
  std::vector<Sides> all;
  Sides sides(y.size(), 1);
  for (size_t k = 0; k + 1 < order.size(); ++k) {
    sides[order[k]] = 0;
    all.push_back(sides);
  }
  return all;
}

class RandomGraph : public testing::TestWithParam<int> {};

TEST_P(RandomGraph, IsNeverCutAboveAnyThresholdOnTheVector) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const CsrGraph graph = random_graph(GetParam(), seed);
    PartitionOptions options;
    const auto refined = spectral_cut(graph, options, std::nullopt);
    options.refine = false;
    const auto bare = spectral_cut(graph, options, std::nullopt);
    ASSERT_TRUE(refined && bare);
    EXPECT_LE(refined->ncut, bare->ncut);
    EXPECT_GE(refined->ncut, refined->lambda_2 - 1e-12);
    for (const Sides& sides : all_thresholds(fiedler_vector(graph)))
      EXPECT_LE(bare->ncut, measure_cut(graph, sides).ncut() * (1 + 1e-12));
  }
}

TEST_P(RandomGraph, HasTheNcutThatIsReported) {
  const CsrGraph graph = random_graph(GetParam(), 7);
  for (const Threshold threshold : {Threshold::mean, Threshold::sign, Threshold::sweep}) {
    PartitionOptions options;
    options.threshold = threshold;
    const auto cut = spectral_cut(graph, options, std::nullopt);
    ASSERT_TRUE(cut);
    EXPECT_DOUBLE_EQ(cut->ncut, measure_cut(graph, cut->sides).ncut());
    EXPECT_EQ(report(*cut).size_a + report(*cut).size_b, GetParam());
    EXPECT_LT(cut->residual, 1e-7);
  }
}

// Both sides of the limits between dense and sparse solvers.
INSTANTIATE_TEST_SUITE_P(Sizes, RandomGraph, testing::Values(3, 12, 60, 200));

// y = -1 0 1 6: the mean is 1.5, the sign cuts between 0 and 1.
TEST(ThresholdCut, FollowsMeanAndSign) {
  const CsrGraph path = whole_graph({4, std::vector<Arc>{{0, 1, 1}, {1, 2, 1}, {2, 3, 1}}});
  const std::vector<double> y = {-1, 0, 1, 6};
  EXPECT_THAT(*threshold_cut(path, y, Threshold::mean), ElementsAre(0, 0, 0, 1));
  EXPECT_THAT(*threshold_cut(path, y, Threshold::sign), ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(*threshold_cut(path, y, Threshold::sweep), ElementsAre(0, 0, 1, 1));
  EXPECT_FALSE(threshold_cut(path, {1, 1, 1, 1}, Threshold::mean));
}

}  // namespace
}  // namespace hmt::graph
