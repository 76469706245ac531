// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/information_loss.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

// Poses all at the origin: then Ad = I and every block of H is a multiple of the 3x3 identity.
PoseGraph chain_at_origin(int n) {
  PoseGraph graph;
  graph.poses.resize(static_cast<size_t>(n));
  for (int i = 0; i + 1 < n; ++i) graph.edges.push_back({i, i + 1, Pose{}, Matrix6d::Identity()});
  return graph;
}

TEST(InformationLoss, IsOneHalfWhenTheOnlyEdgeIsCut) {
  // H = [I -I; -I I]: four blocks of the same norm, two of them off the diagonal.
  const InformationLoss loss = information_loss(chain_at_origin(2), std::vector<int>{0, 1});
  EXPECT_NEAR(loss.total, 0.5, 1e-15);
  EXPECT_NEAR(loss.between.at({0, 1}), 0.5, 1e-15);
}

TEST(InformationLoss, CountsWhatTwoPosesShareByAPoint) {
  // Both see a point at the origin with information I. Marginalized, H = [I/2 -I/2; -I/2 I/2].
  PoseGraph graph;
  graph.poses.resize(3);
  graph.points.resize(1);
  graph.point_edges = {{0, 0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()},
                       {1, 0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()}};
  EXPECT_NEAR(information_loss(graph, std::vector<int>{0, 1, 1}).total, 0.5, 1e-12);
  EXPECT_EQ(information_loss(graph, std::vector<int>{0, 0, 1}).total, 0);
  // A third one: H_ii = 2/3 I, H_ij = -1/3 I, of which one in three pairs stays together.
  graph.point_edges.push_back({2, 0, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()});
  EXPECT_NEAR(information_loss(graph, std::vector<int>{0, 0, 1}).total, 4.0 / 12, 1e-12);
}

TEST(InformationLoss, CountsOnlyTheCutOfAChain) {
  //  0 - 1 | 2    H: diagonal 1 2 1, off-diagonal 4 blocks of 1; the cut edge owns 2 of 8.
  EXPECT_NEAR(information_loss(chain_at_origin(3), std::vector<int>{0, 0, 1}).total, 2.0 / 8,
              1e-15);
}

TEST(InformationLoss, IsZeroForOneGroupAndForNoEdges) {
  EXPECT_EQ(information_loss(chain_at_origin(4), std::vector<int>(4, 0)).total, 0);
  EXPECT_EQ(information_loss(chain_at_origin(1), std::vector<int>{0}).total, 0);
}

TEST(InformationLoss, SumsParallelEdgesOfEitherDirection) {
  PoseGraph graph = chain_at_origin(2);
  graph.edges.push_back({1, 0, Pose{}, 3 * Matrix6d::Identity()});
  EXPECT_NEAR(information_loss(graph, std::vector<int>{0, 1}).total, 0.5, 1e-15);
}

TEST(InformationLoss, RefusesAWrongNumberOfLabels) {
  EXPECT_THROW(information_loss(chain_at_origin(2), std::vector<int>{0}), InputError);
}

}  // namespace
}  // namespace hmt::graph
