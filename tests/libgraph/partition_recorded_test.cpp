// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// The partition against what the authors of [Blanco 2009] got on recorded weight matrices.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <string>

#include "hmt/graph/labels_file.hpp"
#include "hmt/graph/matrix_market.hpp"
#include "hmt/graph/normalized_cut.hpp"
#include "hmt/graph/partition.hpp"
#include "real_data.hpp"

namespace hmt::graph {
namespace {

constexpr double kTau = 0.6667;

struct Case {
  const char* name;
  double authors_top;  // Ncut of their first cut by Eq. 3, from the table of the data
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

WeightedGraph load(const std::string& name) {
  return read_matrix_market(test::data_dir() / "partitions" / (name + ".mtx.gz"));
}

int count_groups(const Labels& labels) {
  return *std::max_element(labels.begin(), labels.end()) + 1;
}

double kway_with_groups(const WeightedGraph& graph, int groups) {
  PartitionOptions options;
  options.groups = groups;
  const Labels labels = recursive_partition(graph, options).labels;
  EXPECT_EQ(count_groups(labels), groups);
  return kway_ncut(graph, labels);
}

class RecordedPartition : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    HMT_REQUIRE_REAL_DATA("partitions/" + std::string(GetParam().name) + ".mtx.gz");
    graph_ = load(GetParam().name);
    options_.tau = kTau;
    bare_ = options_;
    bare_.refine = false;
  }

  WeightedGraph graph_;
  PartitionOptions options_;
  PartitionOptions bare_;  // the best threshold along the exact Fiedler vector, nothing more
};

TEST_P(RecordedPartition, TopCutIsAtOrBelowTheirsAndTheBestThreshold) {
  const double top = recursive_partition(graph_, options_).bisections.at(0).ncut;
  const double threshold = recursive_partition(graph_, bare_).bisections.at(0).ncut;
  EXPECT_LE(top, GetParam().authors_top);
  EXPECT_LE(top, threshold * (1 + 1e-9));
}

TEST_P(RecordedPartition, WithTheirNumberOfGroupsTheKwayNcutIsAtOrBelowTheirs) {
  const Labels theirs = read_labels(test::data_dir() / "partitions" /
                                    (std::string(GetParam().name) + ".authors_labels.txt"));
  EXPECT_LE(kway_with_groups(graph_, count_groups(theirs)), kway_ncut(graph_, theirs) * (1 + 1e-9));
}

TEST_P(RecordedPartition, WithTheGroupsOfTheBareRecursionTheKwayNcutIsAtOrBelowIt) {
  const Labels bare = recursive_partition(graph_, bare_).labels;
  EXPECT_LE(kway_with_groups(graph_, count_groups(bare)), kway_ncut(graph_, bare) * (1 + 1e-9));
}

TEST_P(RecordedPartition, DoesNotDependOnTheOrderOfTheNodes) {
  std::vector<int> place(static_cast<size_t>(graph_.num_nodes()));
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), std::mt19937(3));
  std::vector<Arc> arcs = graph_.arcs();
  for (Arc& arc : arcs)
    arc = {place[static_cast<size_t>(arc.a)], place[static_cast<size_t>(arc.b)], arc.weight};
  const Labels shuffled = recursive_partition({graph_.num_nodes(), arcs}, options_).labels;
  Labels back;
  for (const int p : place) back.push_back(shuffled[static_cast<size_t>(p)]);
  EXPECT_EQ(canonical_labels(back), recursive_partition(graph_, options_).labels);
}

TEST_P(RecordedPartition, LambdaTwoBoundsEveryCutFromBelow) {
  for (const Bisection& cut : recursive_partition(graph_, options_).bisections) {
    EXPECT_LE(cut.lambda_2, cut.ncut + 1e-9);
    EXPECT_LT(cut.ncut, kTau);
    EXPECT_LT(cut.residual, 1e-6);
  }
}

// clang-format off
INSTANTIATE_TEST_SUITE_P(Authors, RecordedPartition, testing::Values(
    Case{"intel_mm", 0.1229}, Case{"intel_mmfix", 0.1831}, Case{"csail_mm", 0.0996},
    Case{"csail_mm_pendant0005", 1.0}, Case{"aces_mm", 0.1511}, Case{"orebro_mm", 0.1771},
    Case{"freiburg-101_mm", 0.2196}, Case{"locdemo_mm", 0.1231}, Case{"malaga_mm", 0.1575},
    Case{"malaga_mm_pendant0005", 1.0}, Case{"sena_mm", 0.1529},
    Case{"synth_block_500", 0.0004075}, Case{"synth_ring_1000", 0.01452},
    Case{"synth_chain_500", 0.01456}, Case{"synth_uneven_500", 0.000264}),
    [](const auto& test_case) {
      std::string name = test_case.param.name;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });
// clang-format on

// One more node on node 0 by a weight of 0.005 changes nothing for the others.
TEST(PendantNode, JoinsItsNeighborAndLeavesTheOtherGroupsAlone) {
  for (const std::string name : {"csail_mm", "malaga_mm"}) {
    HMT_REQUIRE_REAL_DATA("partitions/" + name + ".mtx.gz");
    PartitionOptions options;
    options.tau = kTau;
    Labels expected = recursive_partition(load(name), options).labels;
    expected.push_back(expected[0]);
    EXPECT_EQ(recursive_partition(load(name + "_pendant0005"), options).labels, expected) << name;
  }
}

}  // namespace
}  // namespace hmt::graph
