// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/weighted_graph.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string refusal(int nodes, const std::vector<Arc>& arcs) {
  try {
    WeightedGraph(nodes, arcs);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WeightedGraph, KeepsNeighborsInOrderAndSumsThem) {
  const WeightedGraph graph(4, std::vector<Arc>{{2, 0, 0.5}, {0, 1, 0.25}, {1, 3, 0}});
  EXPECT_EQ(graph.num_nodes(), 4);
  EXPECT_EQ(graph.num_arcs(), 2);
  ASSERT_EQ(graph.neighbors(0).size(), 2u);
  EXPECT_EQ(graph.neighbors(0)[0].node, 1);
  EXPECT_EQ(graph.neighbors(0)[1].node, 2);
  EXPECT_EQ(graph.degree(0), 0.75);
  EXPECT_EQ(graph.degree(3), 0);
  EXPECT_EQ(graph.weight(0, 2), 0.5);
  EXPECT_EQ(graph.weight(2, 0), 0.5);
  EXPECT_EQ(graph.weight(1, 3), 0);
}

TEST(WeightedGraph, GivesEveryArcOnce) {
  const WeightedGraph graph(3, std::vector<Arc>{{2, 1, 3}, {1, 0, 2}});
  const auto arcs = graph.arcs();
  ASSERT_EQ(arcs.size(), 2u);
  EXPECT_THAT((std::vector<double>{arcs[0].weight, arcs[1].weight}), ElementsAre(2, 3));
  EXPECT_EQ(arcs[1].a, 1);
  EXPECT_EQ(arcs[1].b, 2);
}

TEST(WeightedGraph, MayBeEmpty) {
  EXPECT_EQ(WeightedGraph().num_nodes(), 0);
  EXPECT_EQ(WeightedGraph(0, {}).num_nodes(), 0);
  EXPECT_EQ(WeightedGraph(3, {}).num_arcs(), 0);
}

TEST(WeightedGraph, RefusesWhatIsNotAWeightNamingRowAndColumn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(2, {{0, 1, nan}}), HasSubstr("row 0, column 1"));
  EXPECT_THAT(refusal(2, {{1, 0, infinity}}), HasSubstr("finite"));
  EXPECT_THAT(refusal(2, {{1, 0, -0.5}}), HasSubstr("row 1, column 0, weight -0.5"));
  EXPECT_THAT(refusal(2, {{0, 2, 1}}), HasSubstr("[0, 2)"));
  EXPECT_THAT(refusal(2, {{-1, 1, 1}}), HasSubstr("[0, 2)"));
  EXPECT_THAT(refusal(2, {{1, 1, 1}}), HasSubstr("two different nodes"));
  EXPECT_THAT(refusal(3, {{0, 1, 1}, {1, 0, 1}}), HasSubstr("row 0, column 1) is given twice"));
  EXPECT_THAT(refusal(3, {{0, 1, 1e308}, {0, 2, 1e308}}), HasSubstr("node 0 sum to infinity"));
  EXPECT_THAT(refusal(-1, {}), HasSubstr("-1"));
}

}  // namespace
}  // namespace hmt::graph
