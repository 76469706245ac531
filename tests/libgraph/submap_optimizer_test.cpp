// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/submap_optimizer.hpp"

#include <gtest/gtest.h>

#include "hmt/graph/g2o_file.hpp"
#include "hmt/graph/input_error.hpp"
#include "pose_graph_builder.hpp"
#include "real_data.hpp"

namespace hmt::graph {
namespace {

using test::edge;
using test::noisy_graph;

TEST(SubmapOptimizer, ReachesTheFlatOptimumInThePlaneAndInSpace) {
  for (const Space space : {Space::se2, Space::se3}) {
    const PoseGraph graph = noisy_graph(space, 120, 5, 0.03, 21);
    const PoseOptimizerResult flat = optimize(graph, {});
    const SubmapOptimizerResult parts = optimize_by_submaps(graph, {}, 30);
    EXPECT_EQ(parts.submaps.submaps, 4);
    EXPECT_GE(parts.submaps.links, 3);
    EXPECT_NEAR(parts.result.report.chi2, flat.report.chi2, 1e-7 * flat.report.chi2);
    EXPECT_DOUBLE_EQ(parts.result.report.chi2_initial, flat.report.chi2_initial);
    // The end of the line is known to some decimetres; both stop within a hundredth of that.
    EXPECT_LT(boxminus(parts.result.poses[119], flat.poses[119]).norm(), 2e-3);
    EXPECT_EQ(parts.result.poses[0], graph.poses[0]);
  }
}

// 0 -- 1 -- 2 == 3 -- 4 -- 5: two submaps of a line of unit steps that agree exactly; the link
// alone puts the second behind the first, so nothing is left for the refinement.
TEST(SubmapOptimizer, JoinsExactSubmapsExactly) {
  PoseGraph graph;
  for (int i = 0; i < 6; ++i) graph.poses.push_back(Pose::planar(0.1 * i, 0.3, 0));
  for (int i = 0; i < 5; ++i) graph.edges.push_back(edge(i, i + 1, Pose::planar(1, 0, 0)));
  graph.edges.push_back(edge(0, 2, Pose::planar(2, 0, 0)));
  graph.edges.push_back(edge(5, 3, Pose::planar(-2, 0, 0)));
  const SubmapOptimizerResult parts = optimize_by_submaps(graph, {}, 3);
  EXPECT_EQ(parts.submaps.submaps, 2);
  EXPECT_EQ(parts.submaps.links, 1);
  EXPECT_LT(parts.submaps.chi2_before_refinement, 1e-18);
  EXPECT_NEAR(parts.result.poses[5].translation.x(), 5, 1e-9);
}

TEST(SubmapOptimizer, KeepsTheGaugeOfEveryComponent) {
  PoseGraph graph = noisy_graph(Space::se2, 40, 5, 0.03, 22);
  const size_t edges = graph.edges.size();
  for (int i = 0; i < 40; ++i)
    graph.poses.push_back(Pose::planar(50, 0, 1) * graph.poses[static_cast<size_t>(i)]);
  for (size_t k = 0; k < edges; ++k) {
    graph.edges.push_back(graph.edges[k]);
    graph.edges.back().from += 40;
    graph.edges.back().to += 40;
  }
  graph.fixed = {7};
  const SubmapOptimizerResult parts = optimize_by_submaps(graph, {}, 20);
  EXPECT_EQ(parts.result.poses[7], graph.poses[7]);
  EXPECT_EQ(parts.result.poses[40], graph.poses[40]);
  const double flat = optimize(graph, {}).report.chi2;
  EXPECT_NEAR(parts.result.report.chi2, flat, 1e-7 * flat);
}

TEST(SubmapOptimizer, GivesTheSameBytesForAnyNumberOfThreads) {
  const PoseGraph graph = noisy_graph(Space::se3, 150, 6, 0.03, 23);
  PoseOptimizerOptions options;
  const SubmapOptimizerResult one = optimize_by_submaps(graph, options, 25);
  options.threads = 4;
  EXPECT_EQ(one.result.poses, optimize_by_submaps(graph, options, 25).result.poses);
}

TEST(SubmapOptimizer, RefusesRobustLossesAndTinySubmaps) {
  const PoseGraph graph = noisy_graph(Space::se2, 20, 5, 0.03, 24);
  PoseOptimizerOptions options;
  EXPECT_THROW(optimize_by_submaps(graph, options, 1), InputError);
  options.robust = RobustMethod::gnc;
  EXPECT_THROW(optimize_by_submaps(graph, options, 10), InputError);
}

TEST(SubmapOptimizer, ReachesTheOptimumOfCity10000) {
  HMT_REQUIRE_REAL_DATA("pose_graphs/city10000.g2o");
  const G2oFile file = read_g2o(hmt::test::data_dir() / "pose_graphs/city10000.g2o");
  PoseOptimizerOptions options;
  options.threads = 2;
  EXPECT_NEAR(optimize_by_submaps(file.graph, options).result.report.chi2, 511.98516, 5e-4);
}

}  // namespace
}  // namespace hmt::graph
