// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/condense_links.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "hmt/submap/local/optimize_submap.hpp"

namespace hmt::submap {
namespace {

Constraint measured(int a, int b, const Pose& T_a_b, double sigma) {
  return {a, b, ConstraintKind::registration, T_a_b, Matrix6d::Identity() / (sigma * sigma)};
}

// Two submaps of two keyframes each, in a row one metre apart: {0, 1} and {2, 3}.
struct Row {
  graph::Labels labels{0, 0, 1, 1};
  std::vector<Constraint> constraints;
  std::vector<Submap> submaps;
  graph::WeightedGraph overlap{4, std::vector<graph::Arc>{{0, 1, 0.5}, {1, 2, 0.25}, {2, 3, 0.5}}};

  explicit Row(std::vector<Constraint> across) : constraints(std::move(across)) {
    constraints.push_back(measured(0, 1, Pose::planar(1, 0, 0), 0.1));
    constraints.push_back(measured(2, 3, Pose::planar(1, 0, 0), 0.1));
    const std::vector<Pose> T_world_keyframe = {Pose{}, Pose::planar(1, 0, 0),
                                                Pose::planar(2, 0, 0), Pose::planar(3, 0, 0)};
    for (const SubmapJob& job : make_submap_jobs(Space::se2, labels, T_world_keyframe, constraints))
      submaps.push_back(optimize_submap(job));
  }
};

TEST(CondenseLinks, AddsTheCovarianceInsideTheSubmapToThatOfTheConstraint) {
  const Row row({measured(1, 2, Pose::planar(1, 0, 0), 0.2)});
  const auto links =
      condense_links(Space::se2, row.submaps, row.labels, row.constraints, {}, row.overlap, {});
  ASSERT_EQ(links.size(), 1u);
  EXPECT_LT(graph::boxminus(links[0].T_a_b, Pose::planar(2, 0, 0)).norm(), 1e-6);
  // Along the row: 0.1^2 from 0 to 1 and 0.2^2 from 1 to 2.
  EXPECT_NEAR(links[0].covariance(0, 0), 0.05, 1e-6);
  EXPECT_EQ(links[0].evidence, std::vector<int>{0});
}

TEST(CondenseLinks, TwoConstraintsHalveTheVarianceAcrossTheCut) {
  const Row row(
      {measured(1, 2, Pose::planar(1, 0, 0), 0.2), measured(1, 2, Pose::planar(1, 0, 0), 0.2)});
  const auto links =
      condense_links(Space::se2, row.submaps, row.labels, row.constraints, {}, row.overlap, {});
  ASSERT_EQ(links.size(), 1u);
  EXPECT_NEAR(links[0].covariance(0, 0), 0.01 + 0.02, 1e-6);
}

TEST(CondenseLinks, NcutIsThatOfTheTwoGroups) {
  // cut 0.25; assoc of each side 2 * 0.5 + 0.25: Ncut = 0.25 / 1.25 * 2.
  const Row row({measured(1, 2, Pose::planar(1, 0, 0), 0.2)});
  const auto links =
      condense_links(Space::se2, row.submaps, row.labels, row.constraints, {}, row.overlap, {});
  EXPECT_NEAR(links.at(0).ncut, 0.4, 1e-12);
}

TEST(CondenseLinks, TurnsEvidenceThatRunsFromTheLaterSubmapToTheEarlier) {
  Row row({measured(1, 2, Pose::planar(1, 0, 0), 0.2)});
  row.labels = {0, 1, 0, 1};
  row.constraints = {measured(0, 2, Pose::planar(2, 0, 0), 0.1),
                     measured(1, 3, Pose::planar(2, 0, 0), 0.1),
                     measured(1, 2, Pose::planar(1, 0, 0), 0.1)};
  row.submaps.clear();
  const std::vector<Pose> T_world_keyframe = {Pose{}, Pose::planar(1, 0, 0), Pose::planar(2, 0, 0),
                                              Pose::planar(3, 0, 0)};
  for (const SubmapJob& job :
       make_submap_jobs(Space::se2, row.labels, T_world_keyframe, row.constraints))
    row.submaps.push_back(optimize_submap(job));
  const auto links =
      condense_links(Space::se2, row.submaps, row.labels, row.constraints, {}, row.overlap, {});
  ASSERT_EQ(links.size(), 1u);
  EXPECT_LT(graph::boxminus(links[0].T_a_b, Pose::planar(1, 0, 0)).norm(), 1e-6);
}

TEST(CondenseLinks, SameForAnyNumberOfThreads) {
  const Row row({measured(1, 2, Pose::planar(1, 0.1, 0), 0.2),
                 measured(0, 3, Pose::planar(3, 0, 0.02), 0.2)});
  hmt::submap::Run two;
  two.threads = 2;
  EXPECT_EQ(
      condense_links(Space::se2, row.submaps, row.labels, row.constraints, {}, row.overlap, {}),
      condense_links(Space::se2, row.submaps, row.labels, row.constraints, {}, row.overlap, two));
}

TEST(SubmapGraph, HoldsTheFirstFrame) {
  const Row row({measured(1, 2, Pose::planar(1, 0, 0), 0.2)});
  const auto links =
      condense_links(Space::se2, row.submaps, row.labels, row.constraints, {}, row.overlap, {});
  const graph::PoseGraph graph = submap_graph(Space::se2, std::vector<Pose>(2), links);
  EXPECT_EQ(graph.fixed, std::vector<int>{0});
  EXPECT_NEAR(graph.edges.at(0).information(0, 0), 1 / 0.05, 1e-3);
}

}  // namespace
}  // namespace hmt::submap
