// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>

#include "hmt/graph/input_error.hpp"
#include "hmt/graph/point_information_loss.hpp"
#include "hmt/graph/pose_covariance.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "pose_factor.hpp"

namespace hmt::graph {
namespace {

PointEdge measure(int node, int point, const Eigen::Vector3d& p_node, double information) {
  return {node, point, p_node, information * Eigen::Matrix3d::Identity()};
}

/// Two nodes 2 m apart that see the same points exactly; no edge joins the nodes.
PoseGraph two_views(Space space, std::vector<Eigen::Vector3d> points) {
  PoseGraph graph;
  graph.space = space;
  const std::array<Pose, 2> truth = {Pose{}, Pose::planar(2, 1, 0.7)};
  for (size_t k = 0; k < points.size(); ++k)
    for (int node = 0; node < 2; ++node)
      graph.point_edges.push_back(measure(
          node, static_cast<int>(k), truth[static_cast<size_t>(node)].inverse() * points[k], 4));
  graph.poses = {truth[0], Pose::planar(1.8, 1.1, 0.6)};
  graph.points = std::move(points);
  return graph;
}

// Measured at x = 1 with information 1 and at x = 3 with 3: the mean is 2.5, chi2 is 1 * 1.5^2 +
// 3 * 0.5^2 = 3, and the variance 1 / 4.
TEST(PointEdge, GivesTheWeightedMeanOfTwoMeasurements) {
  for (const Space space : {Space::se2, Space::se3}) {
    PoseGraph graph;
    graph.space = space;
    graph.poses = {Pose{}};
    graph.points = {{5, 5, 0}};
    graph.point_edges = {measure(0, 0, {1, 0, 0}, 1), measure(0, 0, {3, 0, 0}, 3)};
    const PoseOptimizerResult result = optimize(graph, {});
    EXPECT_LT((result.points[0] - Eigen::Vector3d(2.5, 0, 0)).norm(), 1e-9);
    EXPECT_NEAR(result.report.chi2, 3, 1e-9);
    EXPECT_EQ(result.report.degrees_of_freedom, space == Space::se2 ? 2 : 3);
    graph.points = result.points;
    Eigen::Matrix3d expected = Eigen::Matrix3d::Identity() / 4;
    if (space == Space::se2) expected(2, 2) = 0;
    EXPECT_LT((PoseCovariance(graph).marginal_point(0).value() - expected).norm(), 1e-12);
    EXPECT_LT((PoseCovariance(graph).relative_point(0, 0).value() - expected).norm(), 1e-12);
  }
}

TEST(PointEdge, TiesPosesThatSeeEnoughCommonPoints) {
  for (const Space space : {Space::se2, Space::se3}) {
    PoseGraph graph = two_views(space, {{1, 3, 0}, {4, 2, 0}, {2, -2, 0}});
    if (space == Space::se3) graph = two_views(space, {{1, 3, 1}, {4, 2, 0}, {2, -2, 2}});
    const PoseOptimizerResult result = optimize(graph, {});
    EXPECT_LT(boxminus(result.poses[1], Pose::planar(2, 1, 0.7)).norm(), 1e-8);
    EXPECT_TRUE(PoseCovariance(graph).ok());
    EXPECT_TRUE(PoseCovariance(graph).relative(0, 1).has_value());
  }
}

TEST(PointEdge, LeavesAPoseFreeToTurnAroundASinglePoint) {
  const PoseCovariance covariance(two_views(Space::se2, {{1, 3, 0}}));
  EXPECT_FALSE(covariance.ok());
  EXPECT_FALSE(covariance.relative(0, 1).has_value());
}

TEST(PointEdge, IsRefusedByGncWhereItContradictsTheOthers) {
  PoseGraph graph = two_views(Space::se2, {{1, 3, 0}, {4, 2, 0}, {2, -2, 0}, {0, 2, 0}});
  graph.point_edges[3].p_node += Eigen::Vector3d(3, -2, 0);
  for (PointEdge& edge : graph.point_edges) edge.information *= 100;
  PoseOptimizerOptions options;
  options.robust = RobustMethod::gnc;
  const PoseOptimizerResult result = optimize(graph, options);
  EXPECT_LT(boxminus(result.poses[1], Pose::planar(2, 1, 0.7)).norm(), 1e-6);
  for (const size_t k : {0u, 1u, 4u, 5u, 6u, 7u}) EXPECT_TRUE(result.report.point_inlier[k]);
  EXPECT_FALSE(result.report.point_inlier[2] && result.report.point_inlier[3]);
}

template <class Chart>
void expect_numeric_derivatives(const Pose& pose, const Eigen::Vector3d& point) {
  std::array<double, Chart::kParameters> node;
  Chart::store(pose, node.data());
  typename Chart::PointByPose J_node;
  typename Chart::PointMatrix J_point;
  const auto local = Chart::linearize_point(node.data(), point.data(), J_node, J_point);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < Chart::kPoint; ++k) {
    Eigen::Vector3d moved = point;
    moved[k] += kStep;
    typename Chart::PointByPose ignored_node;
    typename Chart::PointMatrix ignored_point;
    const auto there =
        Chart::linearize_point(node.data(), moved.data(), ignored_node, ignored_point);
    EXPECT_LT(((there - local) / kStep - J_point.col(k)).norm(), 1e-5);
  }
  // Rotations of the pose from the right.
  for (int k = Chart::kTangent == 3 ? 2 : 3; k < Chart::kTangent; ++k) {
    Vector6d step = Vector6d::Zero();
    step[Chart::kTangent == 3 ? 5 : k] = kStep;
    Chart::store(boxplus(pose, step), node.data());
    typename Chart::PointByPose ignored_node;
    typename Chart::PointMatrix ignored_point;
    const auto there =
        Chart::linearize_point(node.data(), point.data(), ignored_node, ignored_point);
    EXPECT_LT(((there - local) / kStep - J_node.col(k)).norm(), 1e-4);
  }
}

TEST(PointEdge, HasTheDerivativesThatDifferencesGive) {
  expect_numeric_derivatives<PlanarChart>(Pose::planar(1, 2, 0.4), {3, -1, 0});
  Vector6d turn;
  turn << 0.3, -1, 2, 0.5, -0.2, 0.7;
  expect_numeric_derivatives<SpatialChart>(boxplus(Pose{}, turn), {3, -1, 0.5});
}

TEST(PointEdge, IsRefusedWithItsNumber) {
  PoseGraph graph = two_views(Space::se2, {{1, 3, 0}});
  graph.point_edges[1].point = 7;
  EXPECT_THROW(optimize(graph, {}), InputError);
  graph.point_edges[1].point = 0;
  graph.point_edges[1].information(0, 0) = -1;
  EXPECT_THROW(PoseCovariance{graph}, InputError);
}

// One free node, its heading known, its position known with information 2, sees two points with
// information 1 each. Eliminating the position takes 1 * 1 / (2 + 1 + 1) = 1/4 off every block, so
// H has 3/4 on its diagonal and -1/4 beside it: e = (1/4) / (3/4 + 1/4).
TEST(PointInformationLoss, IsThatOfTheBlocksBetweenGroups) {
  PoseGraph graph;
  graph.poses = {Pose{}, Pose{}};
  graph.fixed = {0};
  PoseGraphEdge edge{0, 1, Pose{}, 2 * Matrix6d::Identity()};
  edge.information(5, 5) = 1e12;
  graph.edges = {edge};
  graph.points = {{1, 0, 0}, {0, 1, 0}};
  graph.point_edges = {measure(1, 0, {1, 0, 0}, 1), measure(1, 1, {0, 1, 0}, 1)};
  const std::vector<std::vector<int>> apart = {{0}, {1}};
  const std::vector<std::vector<int>> shared = {{0, 1}, {1}};
  EXPECT_NEAR(point_information_loss(graph, apart), 0.25, 1e-6);
  EXPECT_EQ(PointInformationBlocks(graph).loss(apart), point_information_loss(graph, apart));
  EXPECT_EQ(point_information_loss(graph, shared), 0);
  EXPECT_THROW(point_information_loss(graph, std::vector<std::vector<int>>(3)), InputError);
  // What only a held node sees is independent.
  for (PointEdge& e : graph.point_edges) e.node = 0;
  EXPECT_EQ(point_information_loss(graph, apart), 0);
}

}  // namespace
}  // namespace hmt::graph
