// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/baseline_partition.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

using testing::Each;
using testing::ElementsAre;

// Two triangles joined by one weak arc.
WeightedGraph two_triangles() {
  return {6, std::vector<Arc>{
                 {0, 2, 1}, {0, 4, 1}, {2, 4, 1}, {1, 3, 1}, {1, 5, 1}, {3, 5, 1}, {4, 5, 0.1}}};
}

TEST(BaselinePartition, ConsecutiveRunsDifferByOneAtMost) {
  EXPECT_THAT(consecutive_partition(7, 3), ElementsAre(0, 0, 0, 1, 1, 2, 2));
  EXPECT_THAT(consecutive_partition(3, 3), ElementsAre(0, 1, 2));
  EXPECT_THAT(consecutive_partition(4, 1), Each(0));
}

TEST(BaselinePartition, RunsEndEveryLengthOfTheWay) {
  // Way  0  1  2.5 | 3  5.9 | 12 : runs of 3 from the first node on; 6 to 12 has no node.
  const std::vector<double> way = {10, 11, 12.5, 13, 15.9, 22};
  EXPECT_THAT(runs_of_length(way, 3), ElementsAre(0, 0, 0, 1, 1, 2));
  EXPECT_THAT(runs_of_length(way, 12), ElementsAre(0, 0, 0, 0, 0, 1));
  EXPECT_THAT(runs_of_length(way, 12.1), Each(0));
  EXPECT_THAT(runs_of_length({}, 1), testing::IsEmpty());
}

TEST(BaselinePartition, RunsOfEqualLengthShareTheWay) {
  // 12 in 2 runs of 6: the last node belongs to the last run. In 4 runs of 3 one has no node.
  const std::vector<double> way = {10, 11, 12.5, 13, 15.9, 22};
  EXPECT_THAT(runs_of_equal_length(way, 2), ElementsAre(0, 0, 0, 0, 0, 1));
  EXPECT_THAT(runs_of_equal_length(way, 4), ElementsAre(0, 0, 0, 1, 1, 2));
  EXPECT_THAT(runs_of_equal_length(std::vector<double>{5, 5, 5}, 3), Each(0));
}

TEST(BaselinePartition, RefusesAWayThatFallsOrIsNoNumber) {
  EXPECT_THROW(runs_of_length(std::vector<double>{1, 0.5}, 1), InputError);
  EXPECT_THROW(runs_of_length(std::vector<double>{0, NAN}, 1), InputError);
  EXPECT_THROW(runs_of_length(std::vector<double>{0, 1}, 0), InputError);
  EXPECT_THROW(runs_of_length(std::vector<double>{0, 1}, NAN), InputError);
  EXPECT_THROW(runs_of_equal_length(std::vector<double>{1, 0.5}, 1), InputError);
  EXPECT_THROW(runs_of_equal_length(std::vector<double>{1, 2}, 3), InputError);
}

TEST(BaselinePartition, MetisFindsTheTwoTriangles) {
  EXPECT_THAT(metis_partition(two_triangles(), 2), ElementsAre(0, 1, 0, 1, 0, 1));
  EXPECT_THAT(metis_partition(two_triangles(), 1), Each(0));
  EXPECT_THAT(metis_partition(WeightedGraph(2, {}), 2), ElementsAre(0, 1));
}

TEST(BaselinePartition, RefusesANumberOfGroupsThatCannotBe) {
  EXPECT_THROW(consecutive_partition(3, 4), InputError);
  EXPECT_THROW(consecutive_partition(3, 0), InputError);
  EXPECT_THROW(metis_partition(two_triangles(), 7), InputError);
}

}  // namespace
}  // namespace hmt::graph
