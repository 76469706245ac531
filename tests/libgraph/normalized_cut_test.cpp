// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/normalized_cut.hpp"

#include <gtest/gtest.h>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

//  0 --4-- 1 --1-- 2 --4-- 3
WeightedGraph path_of_four() {
  return {4, std::vector<Arc>{{0, 1, 4}, {1, 2, 1}, {2, 3, 4}}};
}

// Eq. 2: cut = 1. Eq. 3 over ordered pairs: assoc(A, V) = 4 + 4 + 1. Eq. 1: 1/9 + 1/9.
TEST(NormalizedCut, IsEquationOneOnAPathOfFour) {
  const Cut cut = cut_between(path_of_four(), {0, 0, 1, 1}, 0, 1);
  EXPECT_DOUBLE_EQ(cut.cut, 1);
  EXPECT_DOUBLE_EQ(cut.assoc_a, 9);
  EXPECT_DOUBLE_EQ(cut.assoc_b, 9);
  EXPECT_DOUBLE_EQ(cut.ncut(), 2.0 / 9);
}

// Eq. 4 and 5: Nassoc = assoc(A, A) / assoc(A, V) + assoc(B, B) / assoc(B, V) = 2 - Ncut.
TEST(NormalizedCut, IsTwoMinusTheNormalizedAssociation) {
  const Cut cut = cut_between(path_of_four(), {0, 1, 1, 1}, 0, 1);
  const double inside_a = cut.assoc_a - cut.cut;
  const double inside_b = cut.assoc_b - cut.cut;
  EXPECT_DOUBLE_EQ(inside_a, 0);
  EXPECT_DOUBLE_EQ(inside_b, 10);
  EXPECT_DOUBLE_EQ(cut.ncut(), 2 - inside_a / cut.assoc_a - inside_b / cut.assoc_b);
  EXPECT_DOUBLE_EQ(cut.ncut(), 1 + 4.0 / 14);
}

TEST(NormalizedCut, LeavesOtherGroupsOut) {
  const Cut cut = cut_between(path_of_four(), {0, 1, 2, 2}, 0, 1);
  EXPECT_DOUBLE_EQ(cut.assoc_a, 4);
  EXPECT_DOUBLE_EQ(cut.assoc_b, 4);
  EXPECT_DOUBLE_EQ(cut.ncut(), 2);
}

TEST(NormalizedCut, IsZeroWhereNothingIsCut) {
  EXPECT_EQ(cut_between(path_of_four(), {0, 0, 0, 0}, 0, 1).ncut(), 0);
  EXPECT_EQ(cut_between(WeightedGraph(2, {}), {0, 1}, 0, 1).ncut(), 0);
}

TEST(KwayNcut, IsTheNcutForTwoGroups) {
  EXPECT_DOUBLE_EQ(kway_ncut(path_of_four(), {0, 0, 1, 1}), 2.0 / 9);
}

// {0}: 4/4, {1}: 5/5, {2, 3}: 1/9.
TEST(KwayNcut, SumsOverGroups) {
  EXPECT_DOUBLE_EQ(kway_ncut(path_of_four(), {0, 1, 2, 2}), 2 + 1.0 / 9);
}

TEST(KwayNcut, CountsGroupsWithoutArcsAsZero) {
  EXPECT_EQ(kway_ncut(WeightedGraph(3, {}), {0, 1, 2}), 0);
  EXPECT_EQ(kway_ncut(WeightedGraph(), {}), 0);
}

TEST(KwayNcut, RefusesLabelsThatDoNotFitTheGraph) {
  EXPECT_THROW(kway_ncut(path_of_four(), {0, 1, 2}), InputError);
  EXPECT_THROW(kway_ncut(path_of_four(), {0, 1, 2, -1}), InputError);
}

}  // namespace
}  // namespace hmt::graph
