// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/group_refinement.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "hmt/graph/input_error.hpp"
#include "hmt/graph/normalized_cut.hpp"

namespace hmt::graph {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Cliques of `size` nodes and unit arcs in a row, joined by single arcs of weight 0.1.
WeightedGraph row_of_cliques(int cliques, int size) {
  std::vector<Arc> arcs;
  for (int c = 0; c < cliques; ++c) {
    for (int a = 0; a < size; ++a)
      for (int b = a + 1; b < size; ++b) arcs.push_back({c * size + a, c * size + b, 1});
    if (c > 0) arcs.push_back({c * size - 1, c * size, 0.1});
  }
  return {cliques * size, arcs};
}

int count_groups(const Labels& labels) {
  return *std::max_element(labels.begin(), labels.end()) + 1;
}

TEST(RefineGroups, SendsAStrayNodeHome) {
  const WeightedGraph graph = row_of_cliques(3, 3);
  EXPECT_THAT(refine_groups(graph, {0, 0, 1, 1, 1, 1, 2, 2, 2}),
              ElementsAre(0, 0, 0, 1, 1, 1, 2, 2, 2));
}

// One clique is in two groups and two cliques are in one: no move of single nodes helps.
TEST(RefineGroups, MergesTwoGroupsAndCutsAThird) {
  const WeightedGraph graph = row_of_cliques(4, 4);
  EXPECT_THAT(refine_groups(graph, {0, 0, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3, 3, 3, 3, 3}),
              ElementsAre(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3));
}

// One clique in two groups and, out of its reach, two joined cliques in one group of 8 nodes.
TEST(RefineGroups, DoesNotCutGroupsBelowTheMinimumSize) {
  std::vector<Arc> arcs = row_of_cliques(3, 4).arcs();
  std::erase_if(arcs, [](const Arc& arc) { return arc.a == 3 && arc.b == 4; });
  const WeightedGraph graph(12, arcs);
  const Labels given = {0, 0, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2};
  const Labels cut = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2};
  EXPECT_EQ(refine_groups(graph, given, 8), cut);
  const Labels kept = refine_groups(graph, given, 9);
  EXPECT_EQ(kept[4], kept[11]);
  EXPECT_EQ(count_groups(kept), 3);
}

// A chain 0-1-2-...-31 with groups of 9, 8, 8 and 7: the surplus has to pass through two groups.
TEST(RefineGroups, CarriesASurplusOverSeveralGroups) {
  std::vector<Arc> arcs;
  for (int i = 0; i < 32; ++i)
    for (int k = 1; k <= 3 && i + k < 32; ++k) arcs.push_back({i, i + k, 1.0 / k});
  const WeightedGraph graph(32, arcs);
  Labels uneven;
  for (const auto& [label, size] : {std::pair(0, 9), {1, 8}, {2, 8}, {3, 7}})
    uneven.insert(uneven.end(), static_cast<size_t>(size), label);
  Labels even;
  for (int i = 0; i < 32; ++i) even.push_back(i / 8);
  EXPECT_LE(kway_ncut(graph, refine_groups(graph, uneven)), kway_ncut(graph, even) + 1e-12);
}

TEST(RefineGroups, IsNeverWorseAndKeepsTheNumberOfGroups) {
  for (unsigned seed = 0; seed < 30; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> weight(0, 1);
    std::vector<Arc> arcs;
    for (int a = 0; a < 50; ++a)
      for (int b = 0; b < a; ++b)
        if (weight(random) < 0.1) arcs.push_back({a, b, weight(random)});
    const WeightedGraph graph(50, arcs);
    Labels labels;
    for (int i = 0; i < 50; ++i) labels.push_back(static_cast<int>(random() % 6));
    labels = canonical_labels(labels);
    const Labels refined = refine_groups(graph, labels);
    EXPECT_LT(kway_ncut(graph, refined), kway_ncut(graph, labels));
    EXPECT_EQ(count_groups(refined), count_groups(labels));
    EXPECT_EQ(refined, canonical_labels(refined));
  }
}

TEST(RefineGroups, LeavesTheBestAsItIs) {
  const WeightedGraph graph = row_of_cliques(2, 4);
  EXPECT_THAT(refine_groups(graph, {1, 1, 1, 1, 0, 0, 0, 0}), ElementsAre(0, 0, 0, 0, 1, 1, 1, 1));
  EXPECT_THAT(refine_groups(WeightedGraph(), {}), IsEmpty());
  EXPECT_THAT(refine_groups(WeightedGraph(3, {}), {0, 1, 1}), ElementsAre(0, 1, 1));
  EXPECT_THROW(refine_groups(graph, {0}), InputError);
}

}  // namespace
}  // namespace hmt::graph
