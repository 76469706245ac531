// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/partition_comparison.hpp"

#include <gtest/gtest.h>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

TEST(PartitionComparison, IsPerfectForTheSameGroupsUnderOtherNumbers) {
  const PartitionComparison same = compare_partitions({0, 0, 1, 2}, {7, 7, 3, 1});
  EXPECT_EQ(same.adjusted_rand_index, 1);
  EXPECT_EQ(same.variation_of_information_bits, 0);
  EXPECT_EQ(same.nodes, 4);
  EXPECT_EQ(same.groups_a, 3);
  EXPECT_EQ(same.groups_b, 3);
}

// {0 1 | 2 3} and {0 2 | 1 3}: no common pair of 6, 2 pairs in each, 2 * 2 / 6 expected:
// (0 - 2/3) / (2 - 2/3) = -1/2. Knowing one leaves one bit of the other open, both ways.
TEST(PartitionComparison, IsAsComputedByHandForCrossedPairs) {
  const PartitionComparison crossed = compare_partitions({0, 0, 1, 1}, {0, 1, 0, 1});
  EXPECT_DOUBLE_EQ(crossed.adjusted_rand_index, -0.5);
  EXPECT_DOUBLE_EQ(crossed.variation_of_information_bits, 2);
}

// One group against two halves of 2: common pairs 2 = expected 6 * 2 / 6; H(B|A) = 1 bit.
TEST(PartitionComparison, IsNoBetterThanChanceForOneGroupAgainstHalves) {
  const PartitionComparison halves = compare_partitions({0, 0, 0, 0}, {0, 0, 1, 1});
  EXPECT_DOUBLE_EQ(halves.adjusted_rand_index, 0);
  EXPECT_DOUBLE_EQ(halves.variation_of_information_bits, 1);
}

TEST(PartitionComparison, TakesNoneOneAndAllSingles) {
  EXPECT_EQ(compare_partitions({}, {}).adjusted_rand_index, 1);
  EXPECT_EQ(compare_partitions({3}, {1}).adjusted_rand_index, 1);
  EXPECT_EQ(compare_partitions({0, 1, 2}, {2, 1, 0}).adjusted_rand_index, 1);
}

TEST(PartitionComparison, RefusesDifferentLengths) {
  EXPECT_THROW(compare_partitions({0, 1}, {0}), InputError);
}

}  // namespace
}  // namespace hmt::graph
