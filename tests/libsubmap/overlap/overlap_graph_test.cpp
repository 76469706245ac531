// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "hmt/submap/overlap/overlap.hpp"
#include "walls.hpp"

namespace hmt::submap {
namespace {

using graph::WeightedGraph;
using test::room;
using test::scan_walls;
using test::Wall;

/// Keyframes with their true poses and observations.
struct Tour {
  std::vector<Keyframe> keyframes;
  std::vector<Pose> T_world_keyframe;
  std::vector<Observation> observations;

  void add(const Pose& T_world_robot, std::vector<Reading> readings,
           std::vector<LandmarkReading> landmark_readings = {}) {
    Observation observation;
    observation.index = static_cast<int64_t>(observations.size());
    observation.readings = std::move(readings);
    observation.landmark_readings = std::move(landmark_readings);
    keyframes.push_back({static_cast<int>(keyframes.size()), observation.index, 0, T_world_robot});
    T_world_keyframe.push_back(T_world_robot);
    observations.push_back(std::move(observation));
  }

  WeightedGraph overlap(const PairCovariance& covariance, int threads = 1,
                        const OverlapOptions& options = {}) const {
    submap::Run run;
    run.threads = threads;
    return overlap_graph(keyframes, T_world_keyframe, covariance, ObservationVector(observations),
                         options, run);
  }
};

std::optional<Matrix6d> certain(int, int) {
  return Matrix6d(1e-4 * Matrix6d::Identity());
}

/// Along a straight wall, 2 m away from it and looking at it with 90 degrees: each sees 4 m of it.
Tour along_a_wall(int keyframes, double step_m) {
  Tour tour;
  const std::vector<Wall> wall = {{{-100, 2}, {1000, 2}}};
  for (int i = 0; i < keyframes; ++i) {
    const Pose T = Pose::planar(i * step_m, 0, std::numbers::pi / 2);
    tour.add(T, {scan_walls(wall, T, 91, std::numbers::pi / 2)});
  }
  return tour;
}

/// Through two rooms that are joined by a door, there and back, with two scanners.
Tour through_two_rooms() {
  std::vector<Wall> walls = {{{5, -3}, {5, -0.5}}, {{5, 0.5}, {5, 3}}};
  for (const Wall& wall : room(-5, -3, 15, 3)) walls.push_back(wall);
  Tour tour;
  for (int i = 0; i < 60; ++i) {
    const double x = i < 30 ? -4 + 0.6 * i : 13.4 - 0.6 * (i - 30);
    const Pose T = Pose::planar(x, 0.2 * std::sin(i), i < 30 ? 0.0 : 3.0);
    const Pose T_robot_rear = Pose::planar(-0.2, 0, std::numbers::pi);
    Reading front = scan_walls(walls, T);
    Reading rear = scan_walls(walls, T * T_robot_rear, 61);
    rear.sensor = 3;
    rear.T_robot_sensor = T_robot_rear;
    tour.add(T, i % 7 == 3 ? std::vector{front} : std::vector{rear, front});
  }
  return tour;
}

enum class Names { all, some, none };

/// What a sensor at the pose sees of trees on both sides of a road: those within 12 m ahead of it.
LandmarkReading trees_along_a_road(const Pose& T_world_robot, Names names) {
  LandmarkReading reading;
  reading.sensor = 1;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 0.05);
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d p_world(3.0 * i + noise(random), i % 2 == 0 ? 4 : -5, 0);
    const Eigen::Vector3d p = T_world_robot.inverse() * p_world;
    if (p.x() < 0 || p.norm() > 12) continue;
    Landmark tree;
    if (names == Names::all || (names == Names::some && i % 3 != 0)) tree.id = i;
    tree.position_sensor = p + Eigen::Vector3d(noise(random), noise(random), 0);
    tree.covariance_sensor.diagonal() << 0.0025, 0.0025, 0;
    reading.landmarks.push_back(tree);
  }
  return reading;
}

/// Along a road with trees, there and back; without a scanner or with one.
Tour along_trees(Names names, bool with_scanner) {
  Tour tour;
  for (int i = 0; i < 80; ++i) {
    const Pose T = i < 40 ? Pose::planar(4.0 * i, 0, 0) : Pose::planar(4.0 * (79 - i), 1, 3.1);
    std::vector<Reading> scans;
    if (with_scanner) scans = {scan_walls({{{-10, 8}, {190, 8}}}, T)};
    tour.add(T, std::move(scans), {trees_along_a_road(T, names)});
  }
  return tour;
}

/// Omega by its definition: all pairs.
void expect_all_pairs(const Tour& tour, const OverlapOptions& options) {
  const WeightedGraph omega = tour.overlap(certain, 2, options);
  int arcs = 0;
  for (int a = 0; a < omega.num_nodes(); ++a) {
    for (int b = a + 1; b < omega.num_nodes(); ++b) {
      const auto at = [](int i) { return static_cast<size_t>(i); };
      const double exact = observation_overlap(
          tour.observations[at(a)], tour.observations[at(b)],
          relative_pose(tour.T_world_keyframe[at(a)], tour.T_world_keyframe[at(b)]), *certain(a, b),
          options);
      EXPECT_NEAR(omega.weight(a, b), exact < options.min_overlap ? 0.0 : exact, 0.01)
          << a << " " << b;
      if (omega.weight(a, b) > 0) ++arcs;
    }
  }
  EXPECT_GT(arcs, omega.num_nodes());
}

TEST(OverlapGraph, FallsWithTheDistanceAlongAWall) {
  //   ______________________ wall
  //    |  |  |  |  |  |  |   keyframes, 1 m apart, each sees 4 m
  const WeightedGraph omega = along_a_wall(12, 1.0).overlap(certain);
  ASSERT_EQ(omega.num_nodes(), 12);
  for (int a = 0; a < 12; ++a) {
    double last = 1;
    for (int b = a + 1; b < 12; ++b) {
      EXPECT_LE(omega.weight(a, b), last);
      EXPECT_EQ(omega.weight(a, b) > 0, b - a <= 4) << a << " " << b;
      last = omega.weight(a, b);
    }
  }
  // All keyframes see the same wall alike, so only the distance counts.
  for (int a = 1; a + 1 < 12; ++a) EXPECT_NEAR(omega.weight(a, a + 1), omega.weight(0, 1), 0.02);
}

TEST(OverlapGraph, EqualsTheOverlapOfAllPairs) {
  expect_all_pairs(along_a_wall(40, 0.3), OverlapOptions{});
  expect_all_pairs(through_two_rooms(), OverlapOptions{});
  expect_all_pairs(through_two_rooms(), OverlapOptions{.min_overlap = 0.3});
}

TEST(OverlapGraph, EqualsTheOverlapOfAllPairsOfLandmarks) {
  for (const Names names : {Names::all, Names::some, Names::none}) {
    expect_all_pairs(along_trees(names, false), OverlapOptions{});
    expect_all_pairs(along_trees(names, true), OverlapOptions{.min_overlap = 0.1});
  }
}

TEST(OverlapGraph, AsksOnlyForPairsThatHaveANameOrAPlaceInCommon) {
  for (const Names names : {Names::all, Names::none}) {
    const Tour tour = along_trees(names, false);
    std::set<std::pair<int, int>> asked;
    const WeightedGraph omega = tour.overlap([&asked](int a, int b) -> std::optional<Matrix6d> {
      asked.emplace(a, b);
      return certain(a, b);
    });
    EXPECT_GE(asked.size(), static_cast<size_t>(omega.num_arcs()));
    // 3160 pairs in all. Trees stand 3 m apart and may be moved by half of that.
    EXPECT_LT(asked.size(), 1000U);
  }
}

TEST(OverlapGraph, FindsTheSameNameFarAway) {
  // The pose is wrong by far, and known to be: only the name tells.
  Tour tour;
  LandmarkReading reading;
  reading.landmarks = {{5, {1, 0, 0}, Eigen::Matrix3d::Zero(), {}}};
  tour.add(Pose{}, {}, {reading});
  tour.add(Pose::planar(500, 0, 0), {}, {reading});
  const auto vague = [](int, int) { return std::optional(Matrix6d(1e4 * Matrix6d::Identity())); };
  EXPECT_EQ(tour.overlap(vague).weight(0, 1), 1.0);
}

TEST(OverlapGraph, IsTheSameOnAnyNumberOfThreads) {
  const Tour tour = through_two_rooms();
  const auto one = tour.overlap(certain, 1).arcs();
  const auto three = tour.overlap(certain, 3).arcs();
  ASSERT_EQ(one.size(), three.size());
  for (size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].a, three[i].a);
    EXPECT_EQ(one[i].b, three[i].b);
    EXPECT_EQ(one[i].weight, three[i].weight);
  }
}

TEST(OverlapGraph, DoesNotDependOnTheWorldFrame) {
  Tour tour = through_two_rooms();
  const WeightedGraph here = tour.overlap(certain);
  // A map grid of the country: millions of metres from its origin.
  const Pose T_grid_world = Pose::planar(4.5e5, 5.4e6, 1.0);
  for (Pose& T : tour.T_world_keyframe) T = T_grid_world * T;
  const WeightedGraph there = tour.overlap(certain);
  for (int a = 0; a < here.num_nodes(); ++a) {
    for (int b = a + 1; b < here.num_nodes(); ++b) {
      EXPECT_NEAR(here.weight(a, b), there.weight(a, b), 0.01);
    }
  }
}

TEST(OverlapGraph, HasNoArcWhereTheRelativePoseIsNotKnown) {
  const Tour tour = along_a_wall(6, 0.5);
  const auto known_from_0_only = [](int a, int b) -> std::optional<Matrix6d> {
    return a == 0 ? certain(a, b) : std::nullopt;
  };
  const WeightedGraph omega = tour.overlap(known_from_0_only);
  EXPECT_GT(omega.weight(0, 1), 0.5);
  EXPECT_EQ(omega.weight(1, 2), 0.0);
  const auto vague = [](int, int) { return std::optional(Matrix6d(Matrix6d::Identity())); };
  EXPECT_EQ(tour.overlap(vague).num_arcs(), 0);
}

TEST(OverlapGraph, GrowsWithTheLogWhereTheRobotGoesItsRounds) {
  // Rounds of 128 keyframes along a wall, each of which sees 4 m of it.
  const auto rounds = [](int count) {
    Tour tour = along_a_wall(128, 0.3);
    for (int round = 1; round < count; ++round)
      for (int k = 0; k < 128; ++k)
        tour.add(tour.T_world_keyframe[static_cast<size_t>(k)],
                 tour.observations[static_cast<size_t>(k)].readings);
    return tour.overlap(certain, 2);
  };
  const WeightedGraph four = rounds(4), eight = rounds(8), twelve = rounds(12);
  EXPECT_GT(four.num_arcs(), 4 * 128 * 40);
  EXPECT_EQ(twelve.num_arcs() - eight.num_arcs(), eight.num_arcs() - four.num_arcs());
  // The last round overlaps the first as it would alone, and not the one before.
  EXPECT_EQ(twelve.weight(60, 11 * 128 + 61), four.weight(60, 3 * 128 + 61));
  EXPECT_GT(twelve.weight(60, 11 * 128 + 61), 0.5);
  EXPECT_EQ(twelve.weight(7 * 128 + 60, 11 * 128 + 61), 0.0);
}

TEST(OverlapGraph, AsksOnceForEachPairThatCanMeetWithTheSmallerIdFirst) {
  const Tour tour = along_a_wall(60, 2.0);
  std::set<std::pair<int, int>> asked;
  tour.overlap([&asked](int a, int b) -> std::optional<Matrix6d> {
    EXPECT_LT(a, b);
    EXPECT_LE(b - a, 4);
    EXPECT_TRUE(asked.emplace(a, b).second) << "asked twice: " << a << " " << b;
    return certain(a, b);
  });
  EXPECT_GE(asked.size(), 59U);
}

TEST(OverlapGraph, GivesTheArcsOfASectionAndWhatInItIsNew) {
  // The same two places 40 times: one place, then the other, then again the first one.
  Tour tour;
  const std::vector<Wall> walls = room(-5, -3, 15, 3);
  for (int i = 0; i < 240; ++i) {
    const Pose T = Pose::planar(i >= 40 && i < 200 ? 100 + 0.5 * i : 0.01 * (i % 40), 0, 0);
    tour.add(T, {scan_walls(walls, i >= 40 && i < 200 ? Pose{} : T, 61)});
  }
  const ObservationVector observations(tour.observations);
  const auto section = [&](int first) {
    return overlap_of_section(tour.keyframes, tour.T_world_keyframe, first, certain, observations,
                              {}, {});
  };
  const WeightedGraph whole = tour.overlap(certain);
  const SectionOverlap last = section(200);
  size_t expected = 0;
  for (const graph::Arc& arc : whole.arcs()) {
    if (arc.b < 200) continue;
    ++expected;
    EXPECT_EQ(last.graph.weight(arc.a, arc.b), arc.weight) << arc.a << " " << arc.b;
  }
  ASSERT_GT(expected, 40u * 40u);
  EXPECT_EQ(last.graph.arcs().size(), expected);
  for (int k = 0; k < 240; ++k)
    EXPECT_EQ(last.is_reference[static_cast<size_t>(k)] != 0, k < 200) << k;
  // Within one block none is left out, and 200 is the first of one.
  for (const char is_reference : section(0).is_reference) EXPECT_NE(is_reference, 0);
}

TEST(OverlapGraph, TakesNoneOneAndEmptyKeyframes) {
  EXPECT_EQ(Tour{}.overlap(certain).num_nodes(), 0);
  EXPECT_EQ(along_a_wall(1, 1.0).overlap(certain).num_nodes(), 1);
  Tour tour = along_a_wall(2, 0.1);
  tour.add(Pose{}, {});
  tour.add(Pose{}, {Reading{}});
  const WeightedGraph omega = tour.overlap(certain);
  EXPECT_EQ(omega.num_nodes(), 4);
  EXPECT_EQ(omega.num_arcs(), 1);
}

TEST(OverlapGraph, RefusesPosesThatDoNotFitTheKeyframes) {
  Tour tour = along_a_wall(3, 1.0);
  tour.T_world_keyframe.pop_back();
  EXPECT_THROW(tour.overlap(certain), InputError);
}

TEST(OverlapGraph, StopsWhenAsked) {
  const Tour tour = along_a_wall(3, 1.0);
  submap::Run run;
  run.stop = [] { return true; };
  EXPECT_THROW(overlap_graph(tour.keyframes, tour.T_world_keyframe, certain,
                             ObservationVector(tour.observations), {}, run),
               Interrupted);
}

}  // namespace
}  // namespace hmt::submap
