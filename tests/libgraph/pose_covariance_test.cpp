// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pose_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "hmt/graph/input_error.hpp"
#include "pose_factor.hpp"
#include "pose_graph_builder.hpp"

namespace hmt::graph {
namespace {

using test::edge;
using test::noisy_graph;

// 0 --- 1 --- 2 --- 3 along x, unit steps, variance 0.01 a step and coordinate
PoseGraph chain(Space space) {
  PoseGraph graph;
  graph.space = space;
  for (int i = 0; i < 4; ++i) graph.poses.push_back(Pose::planar(i, 0, 0));
  for (int i = 0; i < 3; ++i) graph.edges.push_back(edge(i, i + 1, Pose::planar(1, 0, 0), 100));
  return graph;
}

TEST(PoseCovariance, GrowsAlongAChain) {
  for (const Space space : {Space::se2, Space::se3}) {
    const PoseCovariance covariance(chain(space));
    ASSERT_TRUE(covariance.ok());
    for (int i = 0; i < 4; ++i) {
      const Matrix6d marginal = covariance.marginal(i).value();
      EXPECT_NEAR(marginal(0, 0), 0.01 * i, 1e-12);
      EXPECT_NEAR(marginal(5, 5), 0.01 * i, 1e-12);
      // The heading errors of the steps before move the end sideways by 0, 1, ... i-1 metres.
      const double lever = 0.01 * (i - 1) * i * (2 * i - 1) / 6.0;
      EXPECT_NEAR(marginal(1, 1), 0.01 * i + lever, 1e-12);
    }
    EXPECT_TRUE(covariance.relative(1, 2)->isApprox(covariance.marginal(1).value(), 1e-9));
    EXPECT_EQ(covariance.relative(2, 2).value(), Matrix6d::Zero());
  }
}

TEST(PoseCovariance, HalvesWhereTwoEdgesAgree) {
  PoseGraph graph = chain(Space::se3);
  graph.edges.push_back(graph.edges[1]);
  const PoseCovariance covariance(graph);
  EXPECT_TRUE(covariance.relative(1, 2)->isApprox(0.005 * Matrix6d::Identity(), 1e-9));
}

// 0 --- 1: the information of the one free node is diagonal with 100 and 2500.
TEST(PoseCovariance, ConditionIsTheRatioOfTheEigenvalues) {
  PoseGraph graph;
  graph.poses = {Pose{}, Pose{}};
  graph.edges = {edge(0, 1, Pose{}, 100)};
  graph.edges[0].information(5, 5) = 2500;
  EXPECT_NEAR(PoseCovariance(graph).condition().value(), 25, 1e-6);
  graph.edges[0].information(0, 0) = 0;
  EXPECT_FALSE(PoseCovariance(graph).condition().has_value());
  EXPECT_EQ(PoseCovariance(PoseGraph{}).condition().value(), 1);
}

TEST(PoseCovariance, LeavesTheUnusedRowsOfThePlaneZero) {
  const Matrix6d marginal = PoseCovariance(chain(Space::se2)).marginal(3).value();
  for (const int k : {2, 3, 4}) {
    EXPECT_EQ(marginal.row(k).norm(), 0);
    EXPECT_EQ(marginal.col(k).norm(), 0);
  }
}

/// Covariance of T_a_b through the dense inverse of the information matrix; node 0 is held.
template <class Chart>
Matrix6d dense_relative(const PoseGraph& graph, int a, int b) {
  constexpr int k = Chart::kTangent;
  const auto n = static_cast<Eigen::Index>(graph.poses.size());
  std::vector<std::array<double, Chart::kParameters>> p(graph.poses.size());
  for (size_t i = 0; i < p.size(); ++i) Chart::store(graph.poses[i], p[i].data());
  const auto at = [&p](int i) { return p[static_cast<size_t>(i)].data(); };
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n * k, n * k);
  typename Chart::Matrix J_f, J_t;
  const auto row_of = [&](int from, int to) {
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(k, n * k);
    row.middleCols<k>(from * k) = J_f;
    row.middleCols<k>(to * k) = J_t;
    return row;
  };
  for (const PoseGraphEdge& e : graph.edges) {
    EdgeFactor<Chart>(e).linearize(at(e.from), at(e.to), J_f, J_t);
    const Eigen::MatrixXd row = row_of(e.from, e.to);
    H += row.transpose() * row;
  }
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n * k, n * k);
  const Eigen::Index m = (n - 1) * k;
  S.bottomRightCorner(m, m) = H.bottomRightCorner(m, m).inverse();
  const Pose T_a_b = relative_pose(Chart::load(at(a)), Chart::load(at(b)));
  Chart::linearize(typename Chart::Measurement(T_a_b), at(a), at(b), J_f, J_t);
  const Eigen::MatrixXd row = row_of(a, b);
  return from_chart_block<Chart>(row * S * row.transpose());
}

TEST(PoseCovariance, EqualsTheDenseInverseForAllPairs) {
  const PoseGraph plane = noisy_graph(Space::se2, 30, 4, 0.05, 4);
  const PoseGraph space = noisy_graph(Space::se3, 20, 4, 0.05, 4);
  const PoseCovariance in_plane(plane), in_space(space);
  for (int a = 0; a < 20; ++a) {
    for (int b = 0; b < 20; ++b) {
      if (a == b) continue;
      const Matrix6d p = dense_relative<PlanarChart>(plane, a, b);
      EXPECT_LT((in_plane.relative(a, b).value() - p).norm(), 1e-8 * p.norm());
      const Matrix6d s = dense_relative<SpatialChart>(space, a, b);
      EXPECT_LT((in_space.relative(a, b).value() - s).norm(), 1e-8 * s.norm());
    }
  }
}

TEST(PoseCovariance, RelativeFromTheHeldNodeIsTheMarginal) {
  const PoseCovariance covariance(noisy_graph(Space::se3, 20, 4, 0.05, 6));
  EXPECT_TRUE(covariance.relative(0, 13)->isApprox(covariance.marginal(13).value(), 1e-9));
}

TEST(PoseCovariance, GivesNothingWhereAPoseIsNotDetermined) {
  PoseGraph graph = chain(Space::se2);
  graph.edges[1].information(5, 5) = 0;
  const PoseCovariance covariance(graph);
  EXPECT_FALSE(covariance.ok());
  EXPECT_FALSE(covariance.marginal(3).has_value());
  EXPECT_FALSE(covariance.relative(0, 1).has_value());
}

TEST(PoseCovariance, RelatesTwoComponentsOnlyIfBothAreFixed) {
  PoseGraph graph = chain(Space::se2);
  graph.edges.erase(graph.edges.begin() + 1);
  EXPECT_FALSE(PoseCovariance(graph).relative(1, 3).has_value());
  EXPECT_TRUE(PoseCovariance(graph).relative(2, 3).has_value());
  graph.fixed = {0, 2};
  EXPECT_NEAR(PoseCovariance(graph).relative(1, 3).value()(0, 0), 0.02, 1e-12);
}

TEST(PoseCovariance, GivesTheSameBytesForAnyNumberOfThreads) {
  const PoseGraph graph = noisy_graph(Space::se3, 200, 9, 0.05, 6);
  const PoseCovariance covariance(graph);
  std::vector<std::pair<int, int>> pairs;
  for (int k = 0; k < 200; ++k) pairs.emplace_back(k, (7 * k + 3) % 200);
  const auto one = covariance.relative(pairs, 1);
  EXPECT_EQ(one, covariance.relative(pairs, 4));
  EXPECT_EQ(one[5], covariance.relative(5, 38));
}

TEST(PoseCovariance, RefusesANodeOutsideTheGraph) {
  const PoseCovariance covariance(chain(Space::se2));
  EXPECT_THROW(covariance.marginal(4), InputError);
  EXPECT_THROW(covariance.relative(-1, 0), InputError);
}

}  // namespace
}  // namespace hmt::graph
