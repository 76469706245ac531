// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fiedler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "coarsening.hpp"
#include "multilevel_fiedler.hpp"

namespace hmt::graph {
namespace {

CsrGraph path(int nodes) {
  std::vector<Arc> arcs;
  for (int i = 0; i + 1 < nodes; ++i) arcs.push_back({i, i + 1, 1});
  return whole_graph({nodes, arcs});
}

CsrGraph grid(int width, int height) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> weight(0.5, 1);
  std::vector<Arc> arcs;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int i = y * width + x;
      if (x + 1 < width) arcs.push_back({i, i + 1, weight(random)});
      if (y + 1 < height) arcs.push_back({i, i + width, weight(random)});
    }
  return whole_graph({width * height, arcs});
}

// The normalized Laplacian of a path of n nodes has the eigenvalues 1 - cos(pi k / (n - 1)).
TEST(Fiedler, MatchesTheClosedFormOnPathsOfEverySolver) {
  for (const int nodes : {2, 3, 12, 100, 1000, 20000}) {
    const CsrGraph graph = path(nodes);
    const FiedlerPairs pairs = FiedlerSolver(graph).pairs(3);
    const double expected = 1 - std::cos(std::numbers::pi / (nodes - 1));
    EXPECT_NEAR(pairs.lambda[0], expected, 1e-6 * expected) << nodes;
    EXPECT_LT(pairs.residual, 1e-9) << nodes;
    EXPECT_EQ(pairs.z.cols(), std::min(3, nodes - 1));
  }
}

TEST(Fiedler, MatchesTheClosedFormOnACompleteGraph) {
  std::vector<Arc> arcs;
  for (int a = 0; a < 60; ++a)
    for (int b = 0; b < a; ++b) arcs.push_back({a, b, 2});
  const CsrGraph graph = whole_graph({60, arcs});
  EXPECT_NEAR(FiedlerSolver(graph).pairs(1).lambda[0], 60.0 / 59, 1e-9);
}

// L of a star has the eigenvalues 0, 1 (n - 2 times) and 2: the Krylov space is one vector.
TEST(Fiedler, GivesOrthogonalVectorsOfAMultipleEigenvalue) {
  std::vector<Arc> arcs;
  for (int leaf = 1; leaf < 400; ++leaf) arcs.push_back({0, leaf, 1});
  const CsrGraph star = whole_graph({400, arcs});
  const FiedlerPairs pairs = FiedlerSolver(star).pairs(3);
  ASSERT_EQ(pairs.z.cols(), 3);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(pairs.lambda[k], 1, 1e-9);
  EXPECT_LT((pairs.z.transpose() * pairs.z - Eigen::Matrix3d::Identity()).norm(), 1e-8);
  EXPECT_LT(pairs.z.row(0).norm(), 1e-8);  // the hub
}

// 150 blobs that hang on one hub by weights that differ by a millionth: as many eigenvalues are
// next to each other. Whichever vector of theirs comes out has a Rayleigh quotient among them.
TEST(Fiedler, EndsWhereManyEigenvaluesAreNextToEachOther) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(0, 1e-6);
  std::vector<Arc> arcs;
  for (int blob = 0; blob < 150; ++blob) {
    const int first = 1 + blob * 4;
    arcs.push_back({0, first, 0.01 + 0.01 * noise(random)});
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < a; ++b) arcs.push_back({first + a, first + b, 1});
  }
  const CsrGraph graph = whole_graph({601, arcs});
  const FiedlerPairs pairs = FiedlerSolver(graph).pairs(1);
  // A blob alone: cut 0.01, assoc 12.01.
  EXPECT_NEAR(pairs.lambda[0], 0.01 / 12.01, 1e-5);
  EXPECT_LT(pairs.residual, 1e-8);
}

TEST(MultilevelFiedler, AgreesWithTheFactorOnAGrid) {
  const CsrGraph graph = grid(130, 70);
  const FiedlerPairs exact = FiedlerSolver(graph).pairs(1);
  const FiedlerPairs multilevel = multilevel_fiedler(graph);
  EXPECT_GT(std::abs(exact.z.col(0).dot(multilevel.z.col(0))), 1 - 1e-4);
}

// Nothing to coarsen: every leaf has the hub as its only neighbor. Every eigenvalue but two is 1.
TEST(MultilevelFiedler, CopesWithAStar) {
  std::vector<Arc> arcs;
  for (int leaf = 1; leaf < 5000; ++leaf) arcs.push_back({0, leaf, 1});
  const CsrGraph star = whole_graph({5000, arcs});
  const FiedlerPairs pairs = multilevel_fiedler(star);
  EXPECT_NEAR(pairs.z.col(0).norm(), 1, 1e-9);
  EXPECT_NEAR(pairs.z(0, 0), 0, 1e-3);
}

TEST(Coarsening, KeepsDegreesAndCutsBetweenAggregates) {
  const CsrGraph fine = grid(20, 20);
  const CoarseGraph coarse = coarsen(fine);
  EXPECT_LT(coarse.graph.size(), 0.6 * fine.size());
  Sides fine_sides;
  Sides coarse_sides(static_cast<size_t>(coarse.graph.size()));
  for (size_t a = 0; a < coarse_sides.size(); ++a) coarse_sides[a] = a % 3 == 0 ? 1 : 0;
  for (const int a : coarse.aggregate) fine_sides.push_back(coarse_sides[static_cast<size_t>(a)]);
  const Cut fine_cut = measure_cut(fine, fine_sides);
  const Cut coarse_cut = measure_cut(coarse.graph, coarse_sides);
  EXPECT_NEAR(fine_cut.cut, coarse_cut.cut, 1e-9);
  EXPECT_NEAR(fine_cut.assoc_a, coarse_cut.assoc_a, 1e-9);
  EXPECT_NEAR(fine_cut.assoc_b, coarse_cut.assoc_b, 1e-9);
}

}  // namespace
}  // namespace hmt::graph
