// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/robust_solution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "hmt/submap/local/optimize_submap.hpp"

namespace hmt::submap {
namespace {

// Twice around a square of 4 x 10 keyframes, a metre a step; odometry turns a little too far.
struct TwoLaps {
  std::vector<Pose> truth;
  std::vector<Pose> T_world_keyframe;
  std::vector<Constraint> constraints;

  TwoLaps() {
    Pose step = Pose::planar(1, 0, 0);
    const Pose corner = Pose::planar(1, 0, std::numbers::pi / 2);
    truth = {Pose{}};
    T_world_keyframe = {Pose{}};
    for (int i = 0; i + 1 < 80; ++i) {
      const Pose& T = i % 10 == 9 ? corner : step;
      const Pose drifted = T * Pose::planar(0.001, 0, 0.001);
      truth.push_back(truth.back() * T);
      T_world_keyframe.push_back(T_world_keyframe.back() * drifted);
      constraints.push_back(
          {i, i + 1, ConstraintKind::odometry, drifted, information(0.02, 0.005)});
    }
  }

  static Matrix6d information(double sigma_m, double sigma_rad) {
    Vector6d sigma;
    sigma << sigma_m, sigma_m, sigma_m, sigma_rad, sigma_rad, sigma_rad;
    return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  }
  LoopCandidate loop(int a, int b, const Pose& T_a_b) const {
    LoopCandidate candidate;
    candidate.a = a;
    candidate.b = b;
    candidate.T_a_b = T_a_b;
    candidate.information = information(0.02, 0.005);
    candidate.verdict = LoopVerdict::accepted;
    return candidate;
  }
  Pose true_pose(int a, int b) const {
    return graph::relative_pose(truth[static_cast<size_t>(a)], truth[static_cast<size_t>(b)]);
  }
};

TEST(RobustSolution, ClosesTrueLoopsAndRefusesAFalseOne) {
  TwoLaps laps;
  for (const int k : {2, 15, 28})
    laps.constraints.push_back({k, k + 40, ConstraintKind::loop, laps.true_pose(k, k + 40),
                                TwoLaps::information(0.02, 0.005)});
  laps.constraints.push_back(
      {5, 60, ConstraintKind::loop, Pose::planar(1, 1, 0), TwoLaps::information(0.02, 0.005)});
  const RobustSolution solution =
      solve_robustly(Space::se2, laps.T_world_keyframe, laps.constraints, {}, {});
  ASSERT_EQ(solution.outliers.size(), 1u);
  EXPECT_EQ(solution.outliers[0].b, 60);
  double worst = 0;
  for (size_t k = 0; k < laps.truth.size(); ++k)
    worst = std::max(worst,
                     (solution.T_world_keyframe[k].translation - laps.truth[k].translation).norm());
  EXPECT_LT(worst, 0.5);
}

TEST(ConsistentLoops, MarksTheOneThatDisagrees) {
  const TwoLaps laps;
  std::vector<int> all(80);
  for (int i = 0; i < 80; ++i) all[static_cast<size_t>(i)] = i;
  graph::PoseGraph trajectory =
      keyframe_graph(Space::se2, all, laps.T_world_keyframe, laps.constraints);
  trajectory.fixed = {0};
  const auto judged = consistent_loops(
      {laps.loop(2, 42, laps.true_pose(2, 42)), laps.loop(5, 60, Pose::planar(1, 1, 0)),
       laps.loop(15, 55, laps.true_pose(15, 55)), laps.loop(28, 68, laps.true_pose(28, 68))},
      trajectory);
  EXPECT_EQ(judged[0].verdict, LoopVerdict::accepted);
  EXPECT_EQ(judged[1].verdict, LoopVerdict::inconsistent);
  EXPECT_FALSE(judged[1].reason.empty());
  EXPECT_EQ(judged[2].verdict, LoopVerdict::accepted);
  EXPECT_EQ(judged[3].verdict, LoopVerdict::accepted);
}

TEST(ConsistentLoops, RefusesALoopThatLeavesADirectionFree) {
  const TwoLaps laps;
  std::vector<int> all(80);
  for (int i = 0; i < 80; ++i) all[static_cast<size_t>(i)] = i;
  const graph::PoseGraph trajectory =
      keyframe_graph(Space::se2, all, laps.T_world_keyframe, laps.constraints);
  LoopCandidate corridor = laps.loop(2, 42, laps.true_pose(2, 42));
  corridor.information(0, 0) = 0;
  EXPECT_EQ(consistent_loops({corridor}, trajectory).at(0).verdict, LoopVerdict::unconfirmed);
}

}  // namespace
}  // namespace hmt::submap
