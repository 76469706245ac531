// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/tau_search.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace hmt::graph {
namespace {

using testing::ElementsAre;

// Two triangles of unit arcs joined by one of 0.1. Ncut between them 2 * 0.1 / 6.1 = 0.0328; a node
// cut off its triangle has Ncut 2/2 + 2/4 = 1.5.
WeightedGraph two_triangles() {
  return {6, std::vector<Arc>{
                 {0, 1, 1}, {0, 2, 1}, {1, 2, 1}, {2, 3, 0.1}, {3, 4, 1}, {3, 5, 1}, {4, 5, 1}}};
}

double groups_beyond_one(const Labels& labels) {
  return *std::max_element(labels.begin(), labels.end());
}

std::optional<TauChoice> search(double max_loss) {
  return largest_tau(two_triangles(), {}, groups_beyond_one, max_loss);
}

TEST(TauSearch, StopsBeforeTheCutThatCostsTooMuch) {
  EXPECT_EQ(search(1)->tau, 0.03);
  EXPECT_EQ(search(1)->loss, 0);
  const auto two = search(2);
  EXPECT_EQ(two->tau, 1.5);
  EXPECT_EQ(two->loss, 1);
  EXPECT_THAT(two->partition.labels, ElementsAre(0, 0, 0, 1, 1, 1));
}

TEST(TauSearch, EndsBelowTwoWhereNothingCostsTooMuch) {
  EXPECT_EQ(search(std::numeric_limits<double>::infinity())->tau, 1.99);
}

TEST(TauSearch, FindsNothingWhereEverythingCostsTooMuch) {
  EXPECT_FALSE(search(0));
}

}  // namespace
}  // namespace hmt::graph
