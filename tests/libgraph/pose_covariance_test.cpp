// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/pose_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <random>

#include "hmt/graph/input_error.hpp"
#include "pose_factor.hpp"
#include "pose_graph_builder.hpp"

namespace hmt::graph {
namespace {

using test::edge;
using test::noisy_graph;
using test::noisy_sphere;

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
  EXPECT_NEAR(PoseCovariance(graph).condition().value(), 25, 0.01);
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

/// Covariances of T_a_b through the dense inverse of the information matrix; node 0 is held.
template <class Chart>
class DenseCovariance {
 public:
  explicit DenseCovariance(const PoseGraph& graph) : parameters_(graph.poses.size()) {
    for (size_t i = 0; i < parameters_.size(); ++i)
      Chart::store(graph.poses[i], parameters_[i].data());
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(size(), size());
    typename Chart::Matrix J_from, J_to;
    for (const PoseGraphEdge& e : graph.edges) {
      EdgeFactor<Chart>(e).linearize(at(e.from), at(e.to), J_from, J_to);
      const Eigen::MatrixXd row = row_of(e.from, e.to, J_from, J_to);
      H += row.transpose() * row;
    }
    const Eigen::Index free = size() - Chart::kTangent;
    S_ = Eigen::MatrixXd::Zero(size(), size());
    S_.bottomRightCorner(free, free) = H.bottomRightCorner(free, free).inverse();
  }

  Matrix6d relative(int a, int b) const {
    const Pose T_a_b = relative_pose(Chart::load(at(a)), Chart::load(at(b)));
    typename Chart::Matrix J_a, J_b;
    Chart::linearize(typename Chart::Measurement(T_a_b), at(a), at(b), J_a, J_b);
    const Eigen::MatrixXd row = row_of(a, b, J_a, J_b);
    return from_chart_block<Chart>(row * S_ * row.transpose());
  }

 private:
  Eigen::Index size() const {
    return static_cast<Eigen::Index>(parameters_.size()) * Chart::kTangent;
  }
  const double* at(int node) const { return parameters_[static_cast<size_t>(node)].data(); }
  Eigen::MatrixXd row_of(int a, int b, const typename Chart::Matrix& J_a,
                         const typename Chart::Matrix& J_b) const {
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(Chart::kTangent, size());
    row.template middleCols<Chart::kTangent>(a * Chart::kTangent) = J_a;
    row.template middleCols<Chart::kTangent>(b * Chart::kTangent) = J_b;
    return row;
  }

  std::vector<std::array<double, Chart::kParameters>> parameters_;
  Eigen::MatrixXd S_;
};

/// Compares the covariances of 1000 random pairs with those of the dense inverse.
template <class Chart>
void expect_dense(const PoseGraph& graph) {
  const PoseCovariance sparse(graph);
  const DenseCovariance<Chart> dense(graph);
  std::mt19937 generator(7);
  std::uniform_int_distribution<int> node(0, static_cast<int>(graph.poses.size()) - 1);
  for (int k = 0; k < 1000; ++k) {
    const int a = node(generator);
    const int b = node(generator);
    if (a == b) continue;
    const Matrix6d expected = dense.relative(a, b);
    EXPECT_LT((sparse.relative(a, b).value() - expected).norm(), 1e-8 * expected.norm());
    EXPECT_LT((sparse.relative_by_column(a, b).value() - expected).norm(), 1e-8 * expected.norm());
  }
}

TEST(PoseCovariance, EqualsTheDenseInverseForAThousandPairs) {
  expect_dense<PlanarChart>(noisy_graph(Space::se2, 150, 7, 0.05, 4));
  expect_dense<SpatialChart>(noisy_graph(Space::se3, 80, 7, 0.05, 4));
  expect_dense<SpatialChart>(noisy_sphere(6, 15, 0.05, 5));
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

TEST(PoseCovariance, GivesNothingWhereTheMapMayTurnFreely) {
  for (const Space space : {Space::se2, Space::se3}) {
    PoseGraph graph = noisy_graph(space, 40, 5, 0.05, 3);
    for (PoseGraphEdge& e : graph.edges) {
      e.information.row(5).setZero();
      e.information.col(5).setZero();
    }
    const PoseCovariance covariance(graph);
    EXPECT_FALSE(covariance.ok());
    EXPECT_FALSE(covariance.condition().has_value());
    EXPECT_FALSE(covariance.marginal(0).has_value());
    EXPECT_FALSE(covariance.relative(3, 30).has_value());
    EXPECT_FALSE(covariance.relative_by_column(3, 30).has_value());
    const std::vector<std::pair<int, int>> pairs = {{3, 30}, {1, 1}};
    for (const auto& answer : covariance.relative(pairs, 2)) EXPECT_FALSE(answer.has_value());
  }
}

// A node of its own is a component: it is held, alone in its gauge.
TEST(PoseCovariance, AnswersBesideANodeWithoutEdges) {
  PoseGraph graph = chain(Space::se3);
  graph.poses.push_back(Pose::planar(9, 9, 0));
  const PoseCovariance covariance(graph);
  ASSERT_TRUE(covariance.ok());
  EXPECT_NEAR(covariance.marginal(3).value()(0, 0), 0.03, 1e-12);
  EXPECT_EQ(covariance.marginal(4).value(), Matrix6d::Zero());
  EXPECT_FALSE(covariance.relative(1, 4).has_value());
  EXPECT_FALSE(covariance.relative_by_column(1, 4).has_value());
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
