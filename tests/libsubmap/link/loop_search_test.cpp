// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/loop_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "drive.hpp"

namespace hmt::submap {
namespace {

using test::Drift;
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
                                  int threads = 2) {
  const ObservationVector store(drive.observations);
  LoopProblem problem;
  problem.keyframes = drive.keyframes;
  problem.T_world_keyframe = drive.estimate;
  problem.submap = drive.submap;
  problem.already_tied = [](int, int) { return false; };
  problem.covariance = covariance;
  problem.observations = &store;
  Run run;
  run.threads = threads;
  return search_loops(problem, run);
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

}  // namespace
}  // namespace hmt::submap
