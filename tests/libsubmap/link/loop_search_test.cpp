// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/loop_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "drive.hpp"

namespace hmt::submap {
namespace {

using test::Drive;
using test::Laser;
using test::Wall;

/// Variance of the position that grows with the way between the two keyframes; heading as well.
PairCovariance growing(const Drive& drive, double m_per_m, double rad_per_m) {
  return [&drive, m_per_m, rad_per_m](int a, int b) -> std::optional<Matrix6d> {
    const double way = drive.path_m[static_cast<size_t>(b)] - drive.path_m[static_cast<size_t>(a)];
    Matrix6d covariance = Matrix6d::Zero();
    covariance(0, 0) = covariance(1, 1) = std::pow(m_per_m * way, 2);
    covariance(5, 5) = std::pow(rad_per_m * way, 2);
    return covariance;
  };
}

std::vector<LoopCandidate> search(const Drive& drive, const PairCovariance& covariance,
                                  int threads = 2, Space space = Space::se2, int first_query = 0,
                                  double query_spacing_m = 2) {
  const ObservationVector store(drive.observations);
  LoopProblem problem;
  problem.space = space;
  problem.keyframes = drive.keyframes;
  problem.T_world_keyframe = drive.estimate;
  problem.submap = drive.submap;
  problem.first_query = first_query;
  problem.query_spacing_m = query_spacing_m;
  problem.already_tied = [](int, int) { return false; };
  problem.covariance = covariance;
  problem.observations = &store;
  Run run;
  run.threads = threads;
  return search_loops(problem, run);
}

double error_m(const Drive& drive, const LoopCandidate& c) {
  const Pose T_a_b = graph::relative_pose(drive.truth[static_cast<size_t>(c.a)],
                                          drive.truth[static_cast<size_t>(c.b)]);
  return (T_a_b.translation - c.T_a_b.translation).norm();
}

int count(const std::vector<LoopCandidate>& candidates, LoopVerdict verdict) {
  return static_cast<int>(
      std::count_if(candidates.begin(), candidates.end(),
                    [&](const LoopCandidate& c) { return c.verdict == verdict; }));
}

/// A corridor around a block, 20 m x 12 m, with niches of different width in the outer walls.
std::vector<Wall> ring() {
  return {
      {{-1, -1}, {5, -1}},   {{5, -1}, {5, -2}},     {{5, -2}, {7, -2}},    {{7, -2}, {7, -1}},
      {{7, -1}, {21, -1}},   {{21, -1}, {21, 8}},    {{21, 8}, {22, 8}},    {{22, 8}, {22, 9}},
      {{22, 9}, {21, 9}},    {{21, 9}, {21, 13}},    {{21, 13}, {12, 13}},  {{12, 13}, {12, 15}},
      {{12, 15}, {8.5, 15}}, {{8.5, 15}, {8.5, 13}}, {{8.5, 13}, {-1, 13}}, {{-1, 13}, {-1, -1}},
      {{1, 1}, {19, 1}},     {{19, 1}, {19, 11}},    {{19, 11}, {1, 11}},   {{1, 11}, {1, 1}}};
}

const std::vector<Eigen::Vector2d> kTwiceAround = {{0, 0}, {20, 0}, {20, 12}, {0, 12},
                                                   {0, 0}, {20, 0}, {20, 12}, {0, 12}};

TEST(SearchLoops, ClosesASecondRoundAndNothingWrong) {
  const Drive drive = test::drive(ring(), kTwiceAround, {0.005, 0.0008}, {.noise_m = 0.01});
  const auto candidates = search(drive, growing(drive, 0.015, 0.002));
  EXPECT_GE(count(candidates, LoopVerdict::accepted), 10);
  for (const LoopCandidate& c : candidates) {
    EXPECT_LT(c.a, c.b);
    EXPECT_FALSE(c.reason.empty());
    if (c.verdict != LoopVerdict::accepted) continue;
    const Pose T_a_b = graph::relative_pose(drive.truth[static_cast<size_t>(c.a)],
                                            drive.truth[static_cast<size_t>(c.b)]);
    const Pose error = graph::relative_pose(T_a_b, c.T_a_b);
    EXPECT_LT(error.translation.norm(), 0.15) << c.a << " " << c.b;
    EXPECT_LT(std::abs(error.yaw_rad()), 0.03) << c.a << " " << c.b;
  }
}

TEST(SearchLoops, SearchesForPlacesFromAKeyframeOnAsFarApartAsItIsTold) {
  const Drive drive = test::drive(ring(), kTwiceAround, {0.005, 0.0008}, {.noise_m = 0.01});
  const PairCovariance covariance = growing(drive, 0.015, 0.002);
  const auto all = search(drive, covariance);
  const int first = all[all.size() / 2].b;
  const auto later = search(drive, covariance, 1, Space::se2, first);
  const auto few = search(drive, covariance, 1, Space::se2, 0, 8);
  EXPECT_FALSE(later.empty());
  EXPECT_LT(later.size(), all.size());
  for (const LoopCandidate& c : later) EXPECT_GE(c.b, first);
  EXPECT_FALSE(few.empty());
  EXPECT_LT(2 * few.size(), all.size());
}

TEST(SearchLoops, IsTheSameOnAnyNumberOfThreads) {
  const Drive drive = test::drive(ring(), kTwiceAround, {0.005, 0.0008}, {.noise_m = 0.01});
  const PairCovariance covariance = growing(drive, 0.015, 0.002);
  EXPECT_EQ(search(drive, covariance, 1), search(drive, covariance, 2));
}

TEST(SearchLoops, RefusesToGuessThePlaceAlongACorridor) {
  const Drive drive = test::drive(test::corridor(), {{0, 0}, {40, 0}, {0, 0}}, {0.02, 0.0},
                                  {.field_of_view_rad = 6.2, .max_range_m = 15, .noise_m = 0.01});
  const auto candidates = search(drive, growing(drive, 0.03, 0.001));
  EXPECT_GT(count(candidates, LoopVerdict::ambiguous), 0);
  EXPECT_EQ(count(candidates, LoopVerdict::accepted), 0);
}

TEST(SearchLoops, FindsNothingOnAStraightWay) {
  const Drive drive = test::drive(test::corridor(), {{0, 0}, {60, 0}}, {}, {.max_range_m = 15});
  EXPECT_TRUE(search(drive, growing(drive, 0.01, 0.001)).empty());
}

/// A ring of 24 m a side with the same two niches on all four outer sides.
std::vector<Wall> symmetric_ring() {
  std::vector<Wall> walls = {
      {{2, 2}, {22, 2}}, {{22, 2}, {22, 22}}, {{22, 22}, {2, 22}}, {{2, 22}, {2, 2}}};
  const std::vector<Eigen::Vector2d> side = {{0, 0},  {6, 0},   {6, -1},  {8, -1}, {8, 0},
                                             {16, 0}, {16, -1}, {18, -1}, {18, 0}, {24, 0}};
  const Eigen::Vector2d center(12, 12);
  for (int turn = 0; turn < 4; ++turn) {
    const Eigen::Rotation2Dd R(turn * std::numbers::pi / 2);
    for (size_t i = 0; i + 1 < side.size(); ++i)
      walls.push_back({center + R * (side[i] - center), center + R * (side[i + 1] - center)});
  }
  return walls;
}

TEST(SearchLoops, TakesNoSideOfASymmetricRingForAnother) {
  const Drive drive =
      test::drive(symmetric_ring(), {{1, 1}, {23, 1}, {23, 23}, {1, 23}, {1, 1}, {23, 1}, {23, 12}},
                  {0.01, 0.001}, {.max_range_m = 8, .noise_m = 0.01});
  const auto candidates = search(drive, growing(drive, 0.04, 0.004));
  EXPECT_FALSE(candidates.empty());
  for (const LoopCandidate& c : candidates)
    if (c.verdict == LoopVerdict::accepted) {
      EXPECT_LT(error_m(drive, c), 0.5) << c.a << " " << c.b;
    }
}

TEST(SearchLoops, RefusesAPlaceThatWasSeenThrough) {
  const Laser laser = {.noise_m = 0.01};
  Drive drive = test::drive(ring(), kTwiceAround, {0.005, 0.0008}, laser);
  // On the second round posts stand along the corridors, in sight of everybody on the first round.
  std::vector<Wall> changed = ring();
  for (int i = 0; i < 13; ++i) {
    const double x = 1.5 * i;
    for (const double y : {0.5, 12.5}) changed.push_back({{x, y}, {x + 0.5, y - 0.2}});
  }
  std::mt19937 random(5);
  for (size_t k = drive.truth.size() / 2; k < drive.truth.size(); ++k)
    drive.observations[k] = test::scan(changed, drive.truth[k], laser, random);
  const auto candidates = search(drive, growing(drive, 0.015, 0.002));
  EXPECT_GT(count(candidates, LoopVerdict::contradicted), 0);
}

TEST(SearchLoops, LeavesKnownPosesToRegistration) {
  const Drive drive = test::drive(ring(), kTwiceAround, {}, {});
  EXPECT_TRUE(search(drive, growing(drive, 0.0005, 0.00005)).empty());
}

TEST(SearchLoops, AsksBeforeItSearches) {
  Drive drive = test::drive(ring(), kTwiceAround, {}, {});
  const ObservationVector store(drive.observations);
  LoopProblem problem;
  problem.keyframes = drive.keyframes;
  problem.T_world_keyframe = drive.estimate;
  problem.submap = drive.submap;
  problem.already_tied = [](int, int) { return true; };
  problem.covariance = growing(drive, 0.02, 0.002);
  problem.observations = &store;
  EXPECT_TRUE(search_loops(problem, submap::Run{}).empty());
}

/// The same drive with clouds instead of scans, and an estimate that climbs.
Drive with_clouds(Drive drive, const std::vector<Wall>& walls, double climb_m_per_m) {
  std::mt19937 random(5);
  for (size_t k = 0; k < drive.truth.size(); ++k) {
    drive.observations[k] =
        test::cloud(walls, 3.0, drive.truth[k], {.max_range_m = 30, .noise_m = 0.01}, random);
    drive.observations[k].index = static_cast<int64_t>(k);
    drive.estimate[k].translation.z() += climb_m_per_m * drive.path_m[k];
  }
  return drive;
}

PairCovariance growing_in_space(const Drive& drive, double m_per_m, double rad_per_m) {
  return [&drive, m_per_m, rad_per_m](int a, int b) -> std::optional<Matrix6d> {
    const double way = drive.path_m[static_cast<size_t>(b)] - drive.path_m[static_cast<size_t>(a)];
    Vector6d sigma;
    sigma << Eigen::Vector3d::Constant(m_per_m * way), Eigen::Vector3d::Constant(rad_per_m * way);
    return Matrix6d(sigma.cwiseAbs2().asDiagonal());
  };
}

TEST(SearchLoops, ClosesASecondRoundOfCloudsInSpace) {
  const std::vector<Eigen::Vector2d> around = {{0, 0}, {20, 0}, {20, 12}, {0, 12}, {0, 0}, {12, 0}};
  const Drive drive =
      with_clouds(test::drive(ring(), around, {0.005, 0.0008}, {.beams = 3}), ring(), 0.008);
  const auto candidates = search(drive, growing_in_space(drive, 0.015, 0.002), 2, Space::se3);
  EXPECT_GE(count(candidates, LoopVerdict::accepted), 3);
  for (const LoopCandidate& c : candidates) {
    if (c.verdict != LoopVerdict::accepted) continue;
    EXPECT_LT(error_m(drive, c), 0.06) << c.a << " " << c.b;
    const Pose T_a_b = graph::relative_pose(drive.truth[static_cast<size_t>(c.a)],
                                            drive.truth[static_cast<size_t>(c.b)]);
    EXPECT_LT(graph::boxminus(c.T_a_b, T_a_b).tail<3>().norm(), 0.01) << c.a << " " << c.b;
  }
}

TEST(SearchLoops, MakesNoMapOfARoundThatIsTiedToAnEarlierOne) {
  std::vector<Eigen::Vector2d> corners = kTwiceAround;
  corners.insert(corners.end(), kTwiceAround.begin(), kTwiceAround.begin() + 4);
  const Drive drive = test::drive(ring(), corners, {}, {});
  const ObservationVector store(drive.observations);
  LoopProblem problem;
  problem.keyframes = drive.keyframes;
  problem.T_world_keyframe = drive.estimate;
  problem.submap = drive.submap;
  // One round is 64 m: the first two are tied, the third is not.
  const auto round = [&](int k) {
    return static_cast<int>(drive.path_m[static_cast<size_t>(k)] / 64);
  };
  problem.already_tied = [&](int a, int b) { return round(a) < 2 && round(b) < 2; };
  problem.covariance = growing(drive, 0.01, 0.001);
  problem.observations = &store;
  const auto candidates = search_loops(problem, submap::Run{});
  EXPECT_GT(count(candidates, LoopVerdict::accepted), 10);
  // The map of the end of the first round reaches 8 m into the second.
  for (const LoopCandidate& c : candidates)
    EXPECT_TRUE(drive.path_m[static_cast<size_t>(c.a)] < 64 + 8.5 || round(c.a) == 2) << c.a;
}

}  // namespace
}  // namespace hmt::submap
