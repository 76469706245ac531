// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/partition.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "hmt/graph/input_error.hpp"
#include "hmt/graph/normalized_cut.hpp"

namespace hmt::graph {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

PartitionOptions with_groups(int groups) {
  PartitionOptions options;
  options.groups = groups;
  return options;
}

//  0---1     4---5
//  | X |--*--| X |     all arcs 1, * is the arc 3-4 of weight 0.1
//  2---3     6---7
WeightedGraph two_cliques(double bridge = 0.1) {
  std::vector<Arc> arcs;
  for (int first : {0, 4})
    for (int a = 0; a < 4; ++a)
      for (int b = a + 1; b < 4; ++b) arcs.push_back({first + a, first + b, 1});
  arcs.push_back({3, 4, bridge});
  return {8, arcs};
}

// `groups` blobs of `size` nodes in a row, random weights, weak arcs between neighboring blobs.
WeightedGraph row_of_blobs(int groups, int size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> strong(0.5, 1);
  std::vector<Arc> arcs;
  for (int g = 0; g < groups; ++g)
    for (int a = 0; a < size; ++a) {
      for (int b = a + 1; b < size; ++b)
        arcs.push_back({g * size + a, g * size + b, strong(random)});
      if (g > 0) arcs.push_back({g * size + a, (g - 1) * size + a, 0.05 * strong(random)});
    }
  return {groups * size, arcs};
}

TEST(Partition, SplitsTwoCliquesJoinedByOneArc) {
  const PartitionResult result = recursive_partition(two_cliques(), {});
  EXPECT_THAT(result.labels, ElementsAre(0, 0, 0, 0, 1, 1, 1, 1));
  ASSERT_THAT(result.bisections, SizeIs(1));
  const Bisection& cut = result.bisections[0];
  EXPECT_EQ(cut.size_a, 4);
  EXPECT_EQ(cut.size_b, 4);
  EXPECT_NEAR(cut.ncut, 2 * 0.1 / 12.1, 1e-12);
  EXPECT_LE(cut.lambda_2, cut.ncut);
  EXPECT_LT(cut.residual, 1e-9);
}

// Eq. 10 on two nodes: L = [1 -1; -1 1], so lambda_2 = 2, and the only cut has Ncut 2.
TEST(Partition, KeepsTwoNodesTogetherUnlessTwoGroupsAreAsked) {
  const WeightedGraph graph(2, std::vector<Arc>{{0, 1, 0.3}});
  EXPECT_THAT(recursive_partition(graph, {}).labels, ElementsAre(0, 0));
  const PartitionResult cut = recursive_partition(graph, with_groups(2));
  EXPECT_THAT(cut.labels, ElementsAre(0, 1));
  EXPECT_NEAR(cut.bisections.at(0).ncut, 2, 1e-12);
  EXPECT_NEAR(cut.bisections.at(0).lambda_2, 2, 1e-12);
}

// Path 0-1-2-3 of unit arcs: the normalized Laplacian has the eigenvalues 0, 1/2, 3/2, 2 and the
// middle cut has Ncut 1/3 + 1/3.
TEST(Partition, CutsAPathOfFourInTheMiddle) {
  const WeightedGraph graph(4, std::vector<Arc>{{0, 1, 1}, {1, 2, 1}, {2, 3, 1}});
  PartitionOptions options;
  options.tau = 0.7;
  const PartitionResult result = recursive_partition(graph, options);
  EXPECT_THAT(result.labels, ElementsAre(0, 0, 1, 1));
  EXPECT_NEAR(result.bisections.at(0).ncut, 2.0 / 3, 1e-12);
  EXPECT_NEAR(result.bisections.at(0).lambda_2, 0.5, 1e-12);
  options.tau = 0.6;
  EXPECT_THAT(recursive_partition(graph, options).labels, Each(0));
}

// A star of m unit arcs: k leaves against the rest cost 1 + k / (2 m - k), a complete graph of n
// nodes has lambda_2 = n / (n - 1): neither is cut below tau = 1.
TEST(Partition, KeepsStarsAndCompleteGraphsWhole) {
  PartitionOptions options;
  options.tau = 1;
  std::vector<Arc> star;
  std::vector<Arc> complete;
  for (int a = 1; a < 30; ++a) {
    star.push_back({0, a, 1});
    for (int b = 0; b < a; ++b) complete.push_back({a, b, 0.5});
  }
  EXPECT_THAT(recursive_partition({30, star}, options).labels, Each(0));
  EXPECT_THAT(recursive_partition({30, complete}, options).labels, Each(0));
}

TEST(Partition, TakesOneNodeNoNodeAndNoArcs) {
  EXPECT_THAT(recursive_partition(WeightedGraph(), {}).labels, IsEmpty());
  EXPECT_THAT(recursive_partition(WeightedGraph(1, {}), {}).labels, ElementsAre(0));
  EXPECT_THAT(recursive_partition(WeightedGraph(3, {}), {}).labels, ElementsAre(0, 1, 2));
  EXPECT_THAT(recursive_partition(WeightedGraph(3, std::vector<Arc>{{0, 2, 0}}), {}).labels,
              ElementsAre(0, 1, 2));
}

TEST(Partition, SplitsComponentsFirstAtNcutZero) {
  const WeightedGraph graph(5, std::vector<Arc>{{0, 2, 1}, {1, 4, 1}});
  const PartitionResult result = recursive_partition(graph, {});
  EXPECT_THAT(result.labels, ElementsAre(0, 1, 0, 2, 1));
  ASSERT_THAT(result.bisections, SizeIs(2));
  EXPECT_EQ(result.bisections[0].size_a, 2);
  EXPECT_EQ(result.bisections[0].size_b, 3);
  EXPECT_EQ(result.bisections[1].size_a, 2);
  EXPECT_EQ(result.bisections[1].ncut, 0);
}

// Table 1: the cut of the whole is accepted, that of the halves is not.
TEST(Partition, FollowsTableOneWithEveryThreshold) {
  for (const Threshold threshold : {Threshold::mean, Threshold::sign, Threshold::sweep}) {
    PartitionOptions options;
    options.threshold = threshold;
    options.refine = false;
    const PartitionResult result = recursive_partition(row_of_blobs(5, 9, 3), options);
    EXPECT_THAT(result.bisections, SizeIs(4));
    for (int node = 0; node < 45; ++node)
      EXPECT_EQ(result.labels[static_cast<size_t>(node)], node / 9);
    for (const Bisection& cut : result.bisections) EXPECT_LT(cut.ncut, options.tau);
  }
}

TEST(Partition, DoesNotCutGroupsBelowTheMinimumSize) {
  PartitionOptions options;
  options.min_size = 9;
  EXPECT_THAT(recursive_partition(two_cliques(), options).labels, Each(0));
  options.min_size = 8;
  EXPECT_THAT(recursive_partition(two_cliques(), options).bisections, SizeIs(1));
}

// A node that hangs by a thread on one clique must not keep the two cliques together.
TEST(Partition, IsNotStoppedByAPendantNode) {
  std::vector<Arc> arcs = two_cliques().arcs();
  arcs.push_back({5, 8, 0.005});
  EXPECT_THAT(recursive_partition({9, arcs}, {}).labels, ElementsAre(0, 0, 0, 0, 1, 1, 1, 1, 1));
}

TEST(Partition, MakesTheNumberOfGroupsThatIsAsked) {
  const WeightedGraph graph = row_of_blobs(4, 8, 1);
  for (int k = 1; k <= graph.num_nodes(); ++k) {
    const PartitionResult result = recursive_partition(graph, with_groups(k));
    EXPECT_EQ(*std::max_element(result.labels.begin(), result.labels.end()), k - 1);
  }
  const PartitionResult four = recursive_partition(graph, with_groups(4));
  for (int node = 0; node < 32; ++node) EXPECT_EQ(four.labels[static_cast<size_t>(node)], node / 8);
}

TEST(Partition, SharesComponentsAmongFewerGroups) {
  const WeightedGraph graph(6, std::vector<Arc>{{0, 1, 1}, {2, 3, 1}, {4, 5, 1}});
  EXPECT_THAT(recursive_partition(graph, with_groups(2)).labels, ElementsAre(0, 0, 1, 1, 1, 1));
  EXPECT_THAT(recursive_partition(graph, with_groups(1)).labels, Each(0));
}

TEST(Partition, IsInvariantToTheOrderOfTheNodes) {
  const WeightedGraph graph = row_of_blobs(12, 25, 7);
  std::vector<int> place(static_cast<size_t>(graph.num_nodes()));
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), std::mt19937(5));
  std::vector<Arc> arcs = graph.arcs();
  for (Arc& arc : arcs)
    arc = {place[static_cast<size_t>(arc.a)], place[static_cast<size_t>(arc.b)], arc.weight};
  const Labels expected = recursive_partition(graph, {}).labels;
  const Labels shuffled = recursive_partition({graph.num_nodes(), arcs}, {}).labels;
  Labels back(place.size());
  for (size_t i = 0; i < place.size(); ++i) back[i] = shuffled[static_cast<size_t>(place[i])];
  EXPECT_EQ(canonical_labels(back), expected);
}

TEST(Partition, IsTheSameOnAnyNumberOfThreads) {
  const WeightedGraph graph = row_of_blobs(40, 20, 11);
  const PartitionResult one = recursive_partition(graph, {}, 1);
  const PartitionResult four = recursive_partition(graph, {}, 4);
  EXPECT_EQ(one.labels, four.labels);
  ASSERT_EQ(one.bisections.size(), four.bisections.size());
  for (size_t i = 0; i < one.bisections.size(); ++i) {
    EXPECT_EQ(one.bisections[i].ncut, four.bisections[i].ncut);
    EXPECT_EQ(one.bisections[i].lambda_2, four.bisections[i].lambda_2);
  }
}

TEST(Partition, RefinementOnlyLowersTheTopCut) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> weight(0, 1);
    std::vector<Arc> arcs;
    for (int a = 0; a < 40; ++a)
      for (int b = 0; b < a; ++b)
        if (weight(random) < 0.15 || b == a - 1) arcs.push_back({a, b, weight(random)});
    PartitionOptions refined = with_groups(2);
    PartitionOptions bare = refined;
    bare.refine = false;
    const WeightedGraph graph(40, arcs);
    const Bisection low = recursive_partition(graph, refined).bisections.at(0);
    EXPECT_LE(low.ncut, recursive_partition(graph, bare).bisections.at(0).ncut);
    EXPECT_GE(low.ncut, low.lambda_2 - 1e-12);
  }
}

TEST(Partition, NamesTheOptionThatIsOutOfRange) {
  const auto refusal = [](const PartitionOptions& options, int threads = 1) -> std::string {
    try {
      recursive_partition(two_cliques(), options, threads);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  PartitionOptions options;
  for (const double tau : {0.0, 2.0, -1.0, std::nan("")}) {
    options.tau = tau;
    EXPECT_THAT(refusal(options), HasSubstr("tau"));
  }
  EXPECT_THAT(refusal(with_groups(0)), HasSubstr("groups is 0"));
  EXPECT_THAT(refusal(with_groups(9)), HasSubstr("1 to 8"));
  EXPECT_THAT(refusal({}, 0), HasSubstr("threads"));
  options = {};
  options.min_size = 0;
  EXPECT_THAT(refusal(options), HasSubstr("min_size"));
  options = with_groups(5);
  options.min_size = 4;
  EXPECT_THAT(refusal(options), HasSubstr("min_size 4"));
}

TEST(CanonicalLabels, NumberGroupsByTheirSmallestNode) {
  EXPECT_THAT(canonical_labels({7, 3, 7, -2}), ElementsAre(0, 1, 0, 2));
}

}  // namespace
}  // namespace hmt::graph
