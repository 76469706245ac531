// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/loop_effect.hpp"

#include <gtest/gtest.h>

namespace hmt::submap {
namespace {

Matrix6d information(double x, double y, double yaw) {
  Matrix6d result = Matrix6d::Zero();
  result(0, 0) = x;
  result(1, 1) = y;
  result(5, 5) = yaw;
  return result;
}

LoopCandidate candidate(int a, int b, double x_m, LoopVerdict verdict) {
  LoopCandidate c;
  c.a = a;
  c.b = b;
  c.T_a_b = Pose::planar(x_m, 0, 0);
  c.information = information(4.0 / 3, 4.0 / 3, 4.0 / 3);
  c.verdict = verdict;
  return c;
}

// Two keyframes, odometry says 0 with variance 1/4, the loop 1 m with variance 3/4: together
// 1^2 / (1/4 + 3/4) = 1 more than the odometry alone, which is at 0.
//   0 ---odometry--- 1
//    \-----loop-----/
TEST(RateEffects, IsWhatTheCandidateAddsToTheLeastChi2) {
  const Matrix6d odometry = information(4, 4, 4);
  graph::PoseGraph graph;
  graph.poses = {Pose{}, Pose{}};
  graph.edges = {{0, 1, Pose{}, odometry}};
  graph.fixed = {0};
  const std::vector<Constraint> without = {{0, 1, ConstraintKind::odometry, Pose{}, odometry}};
  std::vector<LoopCandidate> candidates = {candidate(0, 1, 1, LoopVerdict::inconsistent)};
  rate_effects(candidates, graph, without, 1);
  EXPECT_NEAR(candidates[0].chi2_rise, 1, 1e-9);

  // Taken, the optimum lies at 1/4 of the way: (0 * 4 + 1 * 4/3) / (4 + 4/3).
  candidates[0].verdict = LoopVerdict::accepted;
  graph.poses[1] = Pose::planar(0.25, 0, 0);
  graph.edges.push_back({0, 1, candidates[0].T_a_b, candidates[0].information});
  std::vector<Constraint> with = without;
  with.push_back({0, 1, ConstraintKind::loop, candidates[0].T_a_b, candidates[0].information});
  rate_effects(candidates, graph, with, 1);
  EXPECT_NEAR(candidates[0].chi2_rise, 1, 1e-9);
  EXPECT_EQ(candidates[0].verdict, LoopVerdict::accepted);
}

TEST(RateEffects, AnEdgeThatAloneFixesItsEndRaisesNothing) {
  graph::PoseGraph graph;
  graph.poses = {Pose{}, Pose::planar(1, 0, 0)};
  std::vector<LoopCandidate> candidates = {candidate(0, 1, 1, LoopVerdict::accepted)};
  graph.edges = {{0, 1, candidates[0].T_a_b, candidates[0].information}};
  graph.fixed = {0};
  const std::vector<Constraint> constraints = {
      {0, 1, ConstraintKind::loop, candidates[0].T_a_b, candidates[0].information}};
  rate_effects(candidates, graph, constraints, 1);
  EXPECT_NEAR(candidates[0].chi2_rise, 0, 1e-12);
}

TEST(RateEffects, ALostClosureIsAnOutlierAndWithoutAMatchThereIsNoEffect) {
  const Matrix6d odometry = information(4, 4, 4);
  graph::PoseGraph graph;
  graph.poses = {Pose{}, Pose{}};
  graph.edges = {{0, 1, Pose{}, odometry}};
  graph.fixed = {0};
  const std::vector<Constraint> constraints = {{0, 1, ConstraintKind::odometry, Pose{}, odometry}};
  std::vector<LoopCandidate> candidates = {candidate(0, 1, 1, LoopVerdict::accepted),
                                           candidate(0, 1, 1, LoopVerdict::low_score)};
  candidates[1].information.setZero();
  rate_effects(candidates, graph, constraints, 1);
  EXPECT_EQ(candidates[0].verdict, LoopVerdict::outlier);
  EXPECT_EQ(candidates[1].chi2_rise, 0);
}

// A straight way of 101 keyframes a metre apart.
TEST(TellsTheSame, IsAboutOneRevisitAndOnePlace) {
  std::vector<Pose> poses;
  std::vector<double> path_m;
  for (int k = 0; k <= 100; ++k) {
    poses.push_back(Pose::planar(k, 0, 0));
    path_m.push_back(k);
  }
  const LoopCandidate first = candidate(0, 50, 50, LoopVerdict::accepted);
  EXPECT_TRUE(tells_the_same(first, candidate(5, 60, 55.5, LoopVerdict::accepted), poses, path_m));
  EXPECT_FALSE(tells_the_same(first, candidate(5, 60, 57, LoopVerdict::accepted), poses, path_m));
  EXPECT_FALSE(tells_the_same(first, candidate(5, 90, 85, LoopVerdict::accepted), poses, path_m));
}

TEST(JoinCandidates, KeepsPlacesAndDecisions) {
  const std::vector<LoopCandidate> earlier = {candidate(0, 50, 1, LoopVerdict::ambiguous),
                                              candidate(1, 50, 2, LoopVerdict::rejected),
                                              candidate(2, 50, 3, LoopVerdict::accepted)};
  const auto joined = join_candidates(
      earlier,
      {candidate(3, 50, 4, LoopVerdict::accepted), candidate(2, 50, 5, LoopVerdict::low_score),
       candidate(1, 50, 6, LoopVerdict::accepted), candidate(0, 50, 7, LoopVerdict::accepted)});
  ASSERT_EQ(joined.size(), 4u);
  EXPECT_EQ(joined[0].T_a_b.translation.x(), 7);
  EXPECT_EQ(joined[1].verdict, LoopVerdict::rejected);
  EXPECT_EQ(joined[1].T_a_b.translation.x(), 2);
  EXPECT_EQ(joined[2].T_a_b.translation.x(), 3);
  EXPECT_EQ(joined[3].a, 3);
}

}  // namespace
}  // namespace hmt::submap
