// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/local/optimize_submap.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace hmt::submap {
namespace {

Constraint measured(int a, int b, const Pose& T_a_b, double sigma) {
  return {a, b, ConstraintKind::registration, T_a_b, Matrix6d::Identity() / (sigma * sigma)};
}

// Keyframes 3, 5, 8 in a row, one metre apart, heading along it; the start is off and in another
// frame.
SubmapJob row_of_three() {
  SubmapJob job;
  job.id = 7;
  job.keyframes = {3, 5, 8};
  job.T_any_keyframe = {Pose::planar(10, 4, 0.3), Pose::planar(11.2, 4.4, 0.2),
                        Pose::planar(11.9, 4.6, 0.5)};
  job.constraint_ids = {40, 41};
  job.constraints = {measured(3, 5, Pose::planar(1, 0, 0), 0.1),
                     measured(5, 8, Pose::planar(1, 0, 0), 0.1)};
  return job;
}

TEST(OptimizeSubmap, PutsTheFirstKeyframeAtTheOriginAndMeetsTheConstraints) {
  const Submap submap = optimize_submap(row_of_three());
  EXPECT_EQ(submap.id, 7);
  EXPECT_EQ(submap.T_submap_keyframe[0], Pose{});
  EXPECT_LT(graph::boxminus(submap.T_submap_keyframe[1], Pose::planar(1, 0, 0)).norm(), 1e-6);
  EXPECT_LT(graph::boxminus(submap.T_submap_keyframe[2], Pose::planar(2, 0, 0)).norm(), 1e-6);
  EXPECT_NEAR(submap.chi2, 0, 1e-9);
  EXPECT_EQ(submap.degrees_of_freedom, 0);
}

TEST(OptimizeSubmap, CovarianceGrowsAlongTheChain) {
  // Along the row variances add: 0.01, 0.02. Across it the heading of the first step (0.1 rad over
  // 1 m) adds 0.01 more.
  const Submap submap = optimize_submap(row_of_three());
  EXPECT_NEAR(submap.covariances[0].norm(), 0, 1e-12);
  EXPECT_NEAR(submap.covariances[1](0, 0), 0.01, 1e-6);
  EXPECT_NEAR(submap.covariances[2](0, 0), 0.02, 1e-6);
  EXPECT_NEAR(submap.covariances[2](1, 1), 0.03, 1e-6);
  EXPECT_NEAR(submap.covariances[2](5, 5), 0.02, 1e-6);
}

TEST(OptimizeSubmap, RefusesKeyframesThatNothingTies) {
  SubmapJob job = row_of_three();
  job.constraints.pop_back();
  job.constraint_ids.pop_back();
  EXPECT_THROW(optimize_submap(job), InputError);
}

TEST(MakeSubmapJobs, GivesEachConstraintToTheSubmapOfBothItsEnds) {
  const std::vector<Constraint> constraints = {measured(0, 1, {}, 1), measured(1, 2, {}, 1),
                                               measured(2, 3, {}, 1)};
  const auto jobs = make_submap_jobs(Space::se2, {0, 0, 1, 1}, std::vector<Pose>(4), constraints);
  ASSERT_EQ(jobs.size(), 2u);
  EXPECT_EQ(jobs[0].constraint_ids, std::vector<int>{0});
  EXPECT_EQ(jobs[1].constraint_ids, std::vector<int>{2});
  EXPECT_EQ(jobs[1].keyframes, (std::vector<int>{2, 3}));
}

}  // namespace
}  // namespace hmt::submap
