// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pose_optimizer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hmt/graph/chi_squared.hpp"
#include "hmt/graph/input_error.hpp"
#include "pose_graph_builder.hpp"

namespace hmt::graph {
namespace {

using test::edge;
using test::noisy_graph;

constexpr double kPi = std::numbers::pi;

// 3 --- 2
// |     |    one metre a side, a quarter turn to the left at each corner
// 0 --- 1
PoseGraph square() {
  PoseGraph graph;
  graph.poses = {Pose::planar(0, 0, 0), Pose::planar(1.1, 0.1, 1.4), Pose::planar(0.8, 1.2, 3.0),
                 Pose::planar(0.1, 0.9, -1.4)};
  for (int i = 0; i < 4; ++i)
    graph.edges.push_back(edge(i, (i + 1) % 4, Pose::planar(1, 0, kPi / 2)));
  return graph;
}

TEST(PoseOptimizer, ClosesAnExactSquare) {
  const PoseOptimizerResult result = optimize(square(), {});
  EXPECT_EQ(result.report.termination, Termination::converged);
  EXPECT_GT(result.report.chi2_initial, 0.01);
  EXPECT_LT(result.report.chi2, 1e-20);
  EXPECT_LT(boxminus(result.poses[1], Pose::planar(1, 0, kPi / 2)).norm(), 1e-10);
  EXPECT_LT(boxminus(result.poses[2], Pose::planar(1, 1, kPi)).norm(), 1e-10);
  EXPECT_LT(boxminus(result.poses[3], Pose::planar(0, 1, -kPi / 2)).norm(), 1e-10);
}

// 0 --1--> 1 --1--> 2 and 0 --2.3--> 2 along a line: the excess of 0.3 is shared by the three equal
// edges, 0.1 each, chi2 = 3 * 0.01.
PoseGraph triangle(Space space) {
  PoseGraph graph;
  graph.space = space;
  graph.poses = {Pose::planar(0, 0, 0), Pose::planar(1, 0, 0), Pose::planar(2, 0, 0)};
  graph.edges = {edge(0, 1, Pose::planar(1, 0, 0)), edge(1, 2, Pose::planar(1, 0, 0)),
                 edge(0, 2, Pose::planar(2.3, 0, 0))};
  return graph;
}

TEST(PoseOptimizer, SharesTheExcessOfATriangleInThePlaneAndInSpace) {
  for (const Space space : {Space::se2, Space::se3}) {
    const PoseOptimizerResult result = optimize(triangle(space), {});
    EXPECT_NEAR(result.report.chi2_initial, 0.09, 1e-12);
    EXPECT_NEAR(result.report.chi2, 0.03, 1e-12);
    EXPECT_NEAR(result.poses[1].translation.x(), 1.1, 1e-9);
    EXPECT_NEAR(result.poses[2].translation.x(), 2.2, 1e-9);
    for (const double chi2 : result.report.edge_chi2) EXPECT_NEAR(chi2, 0.01, 1e-10);
  }
}

TEST(PoseOptimizer, HoldsTheFixedNodeAndLeavesOtherComponentsTheirOwnGauge) {
  PoseGraph graph = triangle(Space::se2);
  for (int k = 0; k < 3; ++k) graph.poses.push_back(Pose::planar(10 + k, 5, 0));
  for (int k = 0; k < 3; ++k) {
    PoseGraphEdge copy = graph.edges[static_cast<size_t>(k)];
    copy.from += 3;
    copy.to += 3;
    graph.edges.push_back(copy);
  }
  graph.fixed = {2};
  const std::vector<Pose> poses = optimize(graph, {}).poses;
  EXPECT_EQ(poses[2], graph.poses[2]);
  EXPECT_EQ(poses[3], graph.poses[3]);
  EXPECT_NEAR(poses[0].translation.x(), -0.2, 1e-9);
  EXPECT_NEAR(poses[5].translation.x(), 12.2, 1e-9);
}

TEST(PoseOptimizer, ReturnsAGraphWithoutEdgesAsItIs) {
  PoseGraph graph;
  graph.poses = {Pose::planar(1, 2, 3)};
  const PoseOptimizerResult result = optimize(graph, {});
  EXPECT_EQ(result.poses, graph.poses);
  EXPECT_EQ(result.report.termination, Termination::nothing_to_do);
  EXPECT_TRUE(optimize(PoseGraph{}, {}).poses.empty());
}

TEST(PoseOptimizer, SolvesASingularInformationWithinWhatIsMeasured) {
  // The second edge measures x alone.
  PoseGraph graph = triangle(Space::se2);
  graph.edges[1].information = Matrix6d::Zero();
  graph.edges[1].information(0, 0) = 1;
  const PoseOptimizerResult result = optimize(graph, {});
  EXPECT_NEAR(result.report.chi2, 0.03, 1e-9);
  EXPECT_NEAR(result.poses[1].translation.x(), 1.1, 1e-6);
}

// Five unit steps along a line; of three loops, 3 -> 1 contradicts all else.
PoseGraph line_with_false_loop(Space space) {
  PoseGraph graph;
  graph.space = space;
  for (int i = 0; i < 6; ++i) graph.poses.push_back(Pose::planar(i, 0, 0));
  for (int i = 0; i < 5; ++i) graph.edges.push_back(edge(i, i + 1, Pose::planar(1, 0, 0), 100));
  graph.edges.push_back(edge(4, 0, Pose::planar(-4, 0.05, 0), 100));
  graph.edges.push_back(edge(3, 1, Pose::planar(3, 7, 2), 100));
  graph.edges.push_back(edge(5, 2, Pose::planar(-3, 0, 0.02), 100));
  return graph;
}

TEST(PoseOptimizer, GncRefusesTheFalseLoopAlone) {
  for (const Space space : {Space::se2, Space::se3}) {
    PoseOptimizerOptions options;
    options.robust = RobustMethod::gnc;
    const PoseOptimizerResult result = optimize(line_with_false_loop(space), options);
    const std::vector<bool> expected = {true, true, true, true, true, true, false, true};
    EXPECT_EQ(result.report.inlier, expected);
    EXPECT_FALSE(result.report.untrusted_start);
    EXPECT_LT(result.report.chi2, 1);
    EXPECT_GT(result.report.edge_chi2[6], 1000);
    EXPECT_NEAR(result.poses[5].translation.x(), 5, 0.05);
  }
}

// Loops over two and over three steps: a false one closes no cycle, each other edge several.
PoseGraph braided_graph() {
  PoseGraph graph = noisy_graph(Space::se2, 60, 2, 0.02, 11);
  for (const PoseGraphEdge& e : noisy_graph(Space::se2, 60, 3, 0.02, 12).edges)
    if (e.from - e.to == 3) graph.edges.push_back(e);
  return graph;
}

TEST(PoseOptimizer, GncWithoutTrustedEdgesRefusesTheFalseLoopAlone) {
  PoseGraph graph = braided_graph();
  std::vector<bool> expected(graph.edges.size(), true);
  graph.edges[70].T_from_to = graph.edges[70].T_from_to * Pose::planar(1, 0, 0);
  expected[70] = false;
  PoseOptimizerOptions options;
  options.robust = RobustMethod::gnc;
  options.trusted.assign(graph.edges.size(), false);
  const PoseOptimizerReport report = optimize(graph, options).report;
  EXPECT_EQ(report.inlier, expected);
  EXPECT_TRUE(report.untrusted_start);
}

TEST(PoseOptimizer, GncKeepsTheTrueLoopsAmongAsManyFalseOnes) {
  for (const Space space : {Space::se2, Space::se3}) {
    PoseGraph graph = noisy_graph(space, 200, 4, 0.02, 11);
    std::vector<bool> expected(graph.edges.size(), true);
    std::mt19937 generator(12);
    for (int k = 0; k < 50; ++k) {
      const int from = static_cast<int>(generator() % 150);
      const int to = from + 10 + static_cast<int>(generator() % 30);
      const Pose wrong = space == Space::se2
                             ? Pose::planar(static_cast<int>(generator() % 40), 7, 1)
                             : test::random_pose(generator, {9, 9, 9}, 0.5);
      graph.edges.push_back(edge(from, to, wrong, 2500));
      expected.push_back(false);
    }
    PoseOptimizerOptions options;
    options.robust = RobustMethod::gnc;
    EXPECT_EQ(optimize(graph, options).report.inlier, expected);
  }
}

// Two drives side by side; only loops join them, more of them false than true.
//
//   40 --- 41 --- 42 --- 43 --- ... --- 79
//    |                    |
//    0 ---  1 ---  2 ---  3 --- ... --- 39
TEST(PoseOptimizer, GncJoinsTwoDrivesByTheLoopsThatAgree) {
  for (const Space space : {Space::se2, Space::se3}) {
    std::mt19937 generator(5);
    std::normal_distribution<double> normal(0, 0.01);
    PoseGraph graph;
    graph.space = space;
    const auto truth = [](int i) { return Pose::planar(i % 40, i < 40 ? 0 : 1, 0); };
    const auto measure = [&](int from, int to) {
      Vector6d noise;
      for (double& value : noise) value = normal(generator);
      if (space == Space::se2) noise.segment<3>(2).setZero();
      const Pose T_from_to = relative_pose(truth(from), truth(to));
      graph.edges.push_back(edge(from, to, boxplus(T_from_to, noise), 1e4));
    };
    graph.poses.resize(80);
    for (int i = 0; i < 79; ++i)
      if (i != 39) measure(i, i + 1);
    for (int i = 0; i < 40; i += 6) measure(i, i + 40);
    std::vector<bool> expected(graph.edges.size(), true);
    // A stretch of five poses taken for another place.
    for (int k = 0; k < 5; ++k)
      graph.edges.push_back(edge(10 + k, 65 + k, Pose::planar(0, 3, 0), 1e4));
    for (int k = 0; k < 5; ++k)
      graph.edges.push_back(edge(7 * k, 50 + 5 * k, Pose::planar(3 * k, 9, k), 1e4));
    expected.resize(graph.edges.size(), false);
    PoseOptimizerOptions options;
    options.robust = RobustMethod::gnc;
    options.initialization = Initialization::best;
    const PoseOptimizerReport report = optimize(graph, options).report;
    EXPECT_EQ(report.inlier, expected);
    EXPECT_TRUE(report.untrusted_start);
  }
}

// Edges between i and i+1 that are there by chance are not odometry.
TEST(PoseOptimizer, GncTrustsNoNumberingThatSaysNothing) {
  PoseGraph graph = braided_graph();
  const auto place = [](int node) { return node * 37 % 60; };
  std::vector<Pose> poses(graph.poses.size());
  for (int i = 0; i < 60; ++i)
    poses[static_cast<size_t>(place(i))] = graph.poses[static_cast<size_t>(i)];
  graph.poses = poses;
  for (PoseGraphEdge& e : graph.edges) e = edge(place(e.from), place(e.to), e.T_from_to, 2500);
  std::vector<bool> expected(graph.edges.size(), true);
  graph.edges.push_back(edge(20, 21, Pose::planar(5, 5, 1), 2500));
  expected.push_back(false);
  PoseOptimizerOptions options;
  options.robust = RobustMethod::gnc;
  EXPECT_EQ(optimize(graph, options).report.inlier, expected);
}

TEST(PoseOptimizer, GncNeverDoubtsATrustedEdge) {
  PoseOptimizerOptions options;
  options.robust = RobustMethod::gnc;
  options.trusted.assign(8, true);
  const PoseOptimizerResult result = optimize(line_with_false_loop(Space::se2), options);
  EXPECT_EQ(result.report.inlier, std::vector<bool>(8, true));
  EXPECT_GT(result.report.chi2, 100);
}

TEST(PoseOptimizer, HuberWeakensTheFalseLoop) {
  PoseOptimizerOptions options;
  const auto end_of_line = [&](RobustMethod robust) {
    options.robust = robust;
    const auto result = optimize(line_with_false_loop(Space::se2), options);
    return boxminus(result.poses[5], Pose::planar(5, 0, 0)).norm();
  };
  EXPECT_LT(end_of_line(RobustMethod::huber), 0.5 * end_of_line(RobustMethod::none));
}

TEST(PoseOptimizer, BestStartBeatsAWrongGuess) {
  PoseGraph graph = noisy_graph(Space::se3, 40, 7, 0.02, 3);
  const double chi2 = optimize(graph, {}).report.chi2;
  for (size_t i = 1; i < graph.poses.size(); ++i) graph.poses[i] = Pose{};
  PoseOptimizerOptions options;
  options.initialization = Initialization::best;
  const PoseOptimizerReport report = optimize(graph, options).report;
  EXPECT_EQ(report.start, Initialization::chordal);
  EXPECT_NEAR(report.chi2, chi2, 1e-9 * chi2);
}

// One loop of 3000 steps with a noisy heading: where it closes, the poses of the drive are far off.
TEST(PoseOptimizer, ClosesALongRingFromItsOwnGuessAndFromNothing) {
  constexpr int kNodes = 3000;
  const double turn = 2 * std::numbers::pi / kNodes;
  std::mt19937 generator(3);
  std::normal_distribution<double> normal(0, 1);
  PoseGraph graph;
  graph.poses.emplace_back();
  for (int i = 0; i < kNodes; ++i) {
    const Pose T = Pose::planar(1 + 0.002 * normal(generator), 0.002 * normal(generator),
                                turn + 0.001 * normal(generator));
    graph.edges.push_back(edge(i, (i + 1) % kNodes, T, 1 / (0.002 * 0.002)));
    graph.edges.back().information(5, 5) = 1e6;
    if (i + 1 < kNodes) graph.poses.push_back(graph.poses.back() * T);
  }
  PoseOptimizerOptions options;
  options.initialization = Initialization::best;
  const PoseOptimizerReport from_drive = optimize(graph, options).report;
  graph.poses.assign(kNodes, Pose{});
  const PoseOptimizerReport from_nothing = optimize(graph, options).report;
  EXPECT_EQ(from_drive.termination, Termination::converged);
  EXPECT_NEAR(from_drive.chi2, from_nothing.chi2, 1e-6 * from_drive.chi2);
  EXPECT_LT(from_drive.chi2, 20);
}

// Every heading off by as much as 1.2 rad, to and fro: a full Gauss-Newton step raises the cost.
TEST(PoseOptimizer, DampsItsStepsWhereAFullOneGoesTooFar) {
  PoseGraph graph = noisy_graph(Space::se2, 30, 5, 0.02, 4);
  const double chi2 = optimize(graph, {}).report.chi2;
  for (size_t i = 1; i < graph.poses.size(); ++i)
    graph.poses[i] = graph.poses[i] * Pose::planar(0, 0, i % 2 == 0 ? 1.2 : -1.2);
  const PoseOptimizerReport report = optimize(graph, {}).report;
  EXPECT_EQ(report.termination, Termination::converged);
  EXPECT_GT(report.iterations, 4);
  EXPECT_NEAR(report.chi2, chi2, 1e-8 * chi2);
  PoseOptimizerOptions one_step;
  one_step.max_iterations = 1;
  EXPECT_EQ(optimize(graph, one_step).report.termination, Termination::iteration_limit);
}

// Noise of 0.15 m and rad a step, where the file's own guess is meaningless.
TEST(PoseOptimizer, NoFurtherStartBeatsTheFirstOnANoisySphere) {
  PoseOptimizerOptions options;
  options.initialization = Initialization::best;
  options.restarts = 5;
  for (const unsigned seed : {1U, 2U}) {
    const PoseOptimizerReport report =
        optimize(test::noisy_sphere(8, 14, 0.15, seed), options).report;
    ASSERT_EQ(report.starts.size(), 6U);
    EXPECT_NEAR(report.starts[0].cost, report.cost, 1e-6 * report.cost);
    // Of 540 degrees of freedom: 3 standard deviations.
    EXPECT_NEAR(report.chi2, report.degrees_of_freedom, 3 * std::sqrt(2 * 540.0));
  }
}

TEST(PoseOptimizer, GivesTheSameBytesForAnyNumberOfThreads) {
  for (const Space space : {Space::se2, Space::se3}) {
    const PoseGraph graph = noisy_graph(space, 300, 7, 0.02, 1);
    PoseOptimizerOptions options;
    options.robust = RobustMethod::gnc;
    const PoseOptimizerResult one = optimize(graph, options);
    options.threads = 4;
    const PoseOptimizerResult four = optimize(graph, options);
    EXPECT_EQ(one.poses, four.poses);
    EXPECT_EQ(one.report.edge_chi2, four.report.edge_chi2);
  }
}

TEST(PoseOptimizer, IsInvariantToTheFrameOfTheGauge) {
  PoseGraph graph = noisy_graph(Space::se3, 60, 7, 0.02, 5);
  const double chi2 = optimize(graph, {}).report.chi2;
  std::mt19937 generator(2);
  const Pose T_new_old = test::random_pose(generator, {5, -3, 2}, 1);
  for (Pose& pose : graph.poses) pose = T_new_old * pose;
  EXPECT_NEAR(optimize(graph, {}).report.chi2, chi2, 1e-8 * chi2);
}

std::string message_of(const PoseGraph& graph, const PoseOptimizerOptions& options = {}) {
  try {
    optimize(graph, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PoseOptimizer, NamesTheInvalidEdge) {
  PoseGraph graph = square();
  graph.edges[2].to = 9;
  EXPECT_EQ(message_of(graph),
            "pose graph edge 2 (2 -> 9): node 9 is outside the graph of 4 poses");
  graph = square();
  graph.edges[1].to = 1;
  EXPECT_NE(message_of(graph).find("edge 1 (1 -> 1): joins a node to itself"), std::string::npos);
  graph = square();
  graph.edges[3].T_from_to.translation.x() = std::nan("");
  EXPECT_NE(message_of(graph).find("edge 3 (3 -> 0): the relative pose"), std::string::npos);
  graph = square();
  graph.edges[0].information(5, 5) = -1;
  EXPECT_NE(message_of(graph).find("edge 0 (0 -> 1): the information matrix has a negative"),
            std::string::npos);
  graph = square();
  graph.edges[0].information(5, 0) = 0.5;
  EXPECT_NE(message_of(graph).find("not symmetric"), std::string::npos);
  graph = square();
  graph.fixed = {4};
  EXPECT_EQ(message_of(graph), "fixed node 4 is outside the graph of 4 poses");
}

TEST(PoseOptimizer, NamesTheInvalidOption) {
  PoseOptimizerOptions options;
  options.max_iterations = 0;
  EXPECT_EQ(message_of(square(), options), "max_iterations is 0; it must be at least 1");
  options = {};
  options.trusted = {true};
  EXPECT_NE(message_of(square(), options).find("trusted has 1 flags"), std::string::npos);
}

TEST(ChiSquared, QuantilesMatchTheTables) {
  EXPECT_NEAR(chi_squared_quantile(1, 0.95), 3.841459, 1e-6);
  EXPECT_NEAR(chi_squared_quantile(2, 0.99), -2 * std::log(0.01), 1e-12);
  EXPECT_NEAR(chi_squared_quantile(3, 0.95), 7.814728, 1e-6);
  EXPECT_NEAR(chi_squared_quantile(3, 0.999), 16.266236, 1e-6);
  EXPECT_NEAR(chi_squared_quantile(6, 0.95), 12.591587, 1e-6);
  EXPECT_NEAR(chi_squared_survival(6, 22.457744), 0.001, 1e-9);
  // Many degrees of freedom, where the distribution is nearly normal.
  EXPECT_NEAR(chi_squared_quantile(1000000, 0.975), 1e6 + 1.95996 * std::sqrt(2e6), 3);
  EXPECT_NEAR(chi_squared_survival(1000000, 1e6), 0.5, 1e-3);
}

}  // namespace
}  // namespace hmt::graph
