// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/find_route.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace hmt::submap {
namespace {

using testing::ElementsAre;

/// Variance of each direction of every constraint: 0.1 m and 0.1 rad.
constexpr double kVariance = 0.01;

/// Keyframes at the given positions, all looking along x, tied in their order; the first half is
/// submap 0, the others are submap 1.
HybridMap path(const std::vector<Eigen::Vector2d>& positions) {
  HybridMap map;
  const size_t half = (positions.size() + 1) / 2;
  map.submaps.resize(2);
  map.submaps[1].id = 1;
  for (size_t k = 0; k < positions.size(); ++k) {
    const int id = static_cast<int>(k);
    const int submap = k < half ? 0 : 1;
    const Eigen::Vector2d from = positions[submap == 0 ? 0 : half];
    const Eigen::Vector2d p = positions[k] - from;
    map.track.keyframes.push_back({id, id, 0.1 * id, Pose{}});
    map.submap_of_keyframe.push_back(submap);
    map.submaps[static_cast<size_t>(submap)].keyframes.push_back(id);
    map.submaps[static_cast<size_t>(submap)].T_submap_keyframe.push_back(
        Pose::planar(p.x(), p.y(), 0));
  }
  map.T_world_submap = {Pose::planar(positions[0].x(), positions[0].y(), 0),
                        Pose::planar(positions[half].x(), positions[half].y(), 0)};
  return map;
}

void tie(HybridMap& map, int a, int b) {
  Constraint constraint{a, b, ConstraintKind::registration,
                        graph::relative_pose(world_pose(map, a), world_pose(map, b)),
                        Matrix6d::Identity() / kVariance};
  map.constraints.push_back(constraint);
}

HybridMap driven(const std::vector<Eigen::Vector2d>& positions) {
  HybridMap map = path(positions);
  for (int k = 0; k + 1 < static_cast<int>(positions.size()); ++k) tie(map, k, k + 1);
  return map;
}

std::vector<int> keyframes(const Route& route) {
  std::vector<int> numbers;
  for (const RouteStep& step : route.steps) numbers.push_back(step.keyframe);
  return numbers;
}

/// Round a square of 2 m, ending half a metre before its beginning.
const std::vector<Eigen::Vector2d> kRound = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {0, 0.5}};

TEST(FindRoute, FollowsTheWayTheRobotDrove) {
  const Route route = find_route(driven(kRound), {0, 0.6, {}}, {2.3, 0.4, {}}, 1);
  EXPECT_THAT(keyframes(route), ElementsAre(4, 3, 2, 1));
  EXPECT_NEAR(route.length_m(), 1.5 + 2 + 2, 1e-12);
  EXPECT_NEAR(route.start_distance_m, 0.1, 1e-12);
  EXPECT_NEAR(route.goal_distance_m, 0.5, 1e-12);
}

TEST(FindRoute, CrossesWhereTwoVisitsAreTiedAndClose) {
  HybridMap map = driven(kRound);
  tie(map, 0, 4);
  const Route route = find_route(map, {0, 0.6, {}}, {2, 0, {}}, 1);
  EXPECT_THAT(keyframes(route), ElementsAre(4, 0, 1));
  EXPECT_NEAR(route.length_m(), 2.5, 1e-12);
  EXPECT_EQ(route.steps[0].submap, 1);
  EXPECT_EQ(route.steps[1].submap, 0);
}

TEST(FindRoute, DoesNotCrossWhereTheRobotsWereFarApart) {
  HybridMap map = driven(kRound);
  tie(map, 1, 4);  // they see the same, 2.06 m apart
  EXPECT_THAT(keyframes(find_route(map, {0, 0.6, {}}, {2, 0, {}}, 1)), ElementsAre(4, 3, 2, 1));
}

// Two steps of a metre along x: x and yaw have twice the variance of a step; y has a third one from
// the yaw of the first step at the end of the second.
TEST(FindRoute, UncertaintyGrowsAlongTheWay) {
  const Route route = find_route(driven({{0, 0}, {1, 0}, {2, 0}}), {0, 0, {}}, {2, 0, {}}, 1);
  ASSERT_EQ(route.steps.size(), 3u);
  EXPECT_TRUE(route.steps[0].covariance.isZero(0));
  const Matrix6d& end = route.steps[2].covariance;
  EXPECT_NEAR(end(0, 0), 2 * kVariance, 1e-9);
  EXPECT_NEAR(end(1, 1), 3 * kVariance, 1e-9);
  EXPECT_NEAR(end(5, 5), 2 * kVariance, 1e-9);
}

TEST(FindRoute, HeightChoosesAmongFloorsIfItIsGiven) {
  HybridMap map = driven({{0, 0}, {1, 0}, {1.1, 0}, {0.1, 0}});
  map.track.space = Space::se3;
  map.T_world_submap[1].translation.z() = 3;
  EXPECT_EQ(find_route(map, {0, 0, {}}, {1, 0, 3.0}, 1).steps.back().keyframe, 2);
  EXPECT_EQ(find_route(map, {0, 0, {}}, {1, 0, {}}, 1).steps.back().keyframe, 1);
}

TEST(FindRoute, OfOnePlaceIsOneKeyframe) {
  const Route route = find_route(driven(kRound), {2, 2, {}}, {2, 2, {}}, 1);
  EXPECT_THAT(keyframes(route), ElementsAre(2));
  EXPECT_EQ(route.length_m(), 0);
}

TEST(FindRoute, RefusesPlacesThatAreNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(find_route(driven(kRound), {nan, 0, {}}, {2, 2, {}}, 1), InputError);
  EXPECT_THROW(find_route(driven(kRound), {0, 0, {}}, {0, 2, nan}, 1), InputError);
}

TEST(FindRoute, SaysWhichKeyframesAreNotTied) {
  HybridMap map = path(kRound);
  tie(map, 0, 1);
  EXPECT_THROW(find_route(map, {0, 0, {}}, {2, 2, {}}, 1), InputError);
}

}  // namespace
}  // namespace hmt::submap
