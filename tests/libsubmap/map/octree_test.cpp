// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/map/octree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>

#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

constexpr double kResolution = 0.1;

Observation observation_of(std::vector<Eigen::Vector3f> points,
                           std::vector<Eigen::Vector3f> misses = {}) {
  Observation observation;
  observation.readings.resize(1);
  observation.readings[0].max_range_m = 50;
  observation.readings[0].points_sensor = std::move(points);
  observation.readings[0].misses_sensor = std::move(misses);
  return observation;
}

std::string tree_of(std::vector<Observation> observations, Space space = Space::se2) {
  std::vector<PlacedObservation> placed;
  for (size_t k = 0; k < observations.size(); ++k) placed.push_back({static_cast<int64_t>(k), {}});
  return build_octree(placed, ObservationVector(std::move(observations)), space, {kResolution});
}

// The robot at the origin sees a wall along x = 2 (points at x = 2.05, the center of a cell):
//
//   y  1      #
//      0  R   #
//     -1      #
//         0 1 2 x
TEST(Octree, WallIsOccupiedAndTheSpaceBeforeItIsFree) {
  std::vector<Eigen::Vector3f> wall;
  for (int k = -10; k <= 10; ++k) wall.push_back({2.05f, 0.1f * static_cast<float>(k) + 0.05f, 0});
  const std::vector<OctreeCell> cells = octree_cells(tree_of({observation_of(wall)}));
  int occupied = 0;
  int free = 0;
  for (const OctreeCell& cell : cells) {
    EXPECT_NEAR(cell.center.z(), kResolution / 2, 1e-6);
    EXPECT_NEAR(cell.size_m, kResolution, 1e-9);
    if (cell.occupied) {
      EXPECT_NEAR(cell.center.x(), 2.05, 1e-6);
      ++occupied;
    } else {
      EXPECT_LT(cell.center.x(), 2.0);
      EXPECT_GT(cell.center.x(), 0.0);
      ++free;
    }
  }
  EXPECT_EQ(occupied, 21);
  // The triangle before the wall has an area of 2 m x 2.1 m / 2, that is 210 cells, and its border
  // cells are cut.
  EXPECT_GT(free, 210);
  EXPECT_LT(free, 260);
}

TEST(Octree, MissClearsFiveMeters) {
  const std::vector<OctreeCell> cells = octree_cells(tree_of({observation_of({}, {{1, 0, 0}})}));
  ASSERT_EQ(cells.size(), 50u);
  for (const OctreeCell& cell : cells) EXPECT_FALSE(cell.occupied);
  EXPECT_NEAR(
      std::max_element(cells.begin(), cells.end(),
                       [](const auto& a, const auto& b) { return a.center.x() < b.center.x(); })
          ->center.x(),
      4.95, 1e-6);
}

TEST(Octree, ObservationsAreDrawnWhereTheyStand) {
  const ObservationVector store({observation_of({{1.05f, 0, 0}})});
  const std::vector<PlacedObservation> placed = {{0, Pose::planar(3, 4, std::numbers::pi / 2)}};
  const auto cells = octree_cells(build_octree(placed, store, Space::se2, {kResolution}));
  const auto wall = std::find_if(cells.begin(), cells.end(), [](auto& c) { return c.occupied; });
  ASSERT_NE(wall, cells.end());
  EXPECT_NEAR(wall->center.x(), 3.05, 0.051);
  EXPECT_NEAR(wall->center.y(), 5.05, 1e-6);
}

/// Nobody but the caller holds what it loads; once released, it has no readings any more.
class ForgetfulStore : public ObservationStore {
 public:
  explicit ForgetfulStore(Observation observation) : observation_(std::move(observation)) {}
  std::shared_ptr<const Observation> load(int64_t) const override {
    return {&observation_, [this](const Observation*) { observation_.readings.clear(); }};
  }

 private:
  mutable Observation observation_;
};

TEST(Octree, HoldsAnObservationWhileItIsDrawn) {
  const ForgetfulStore store(observation_of({{1.05f, 0, 0}}));
  const std::string tree = build_octree({{{0, {}}}}, store, Space::se2, {kResolution});
  EXPECT_EQ(octree_cells(tree).size(), 11u);
}

TEST(Octree, LeavesOutPointsThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const auto tree = tree_of({observation_of({{nan, 0, 0}, {inf, 0, 0}, {1e30f, 0, 0}})});
  EXPECT_TRUE(octree_cells(tree).empty());
}

/// Points on a wavy surface around the robot; no randomness needed.
std::vector<Eigen::Vector3f> wavy_points(int n, float phase) {
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < n; ++k) {
    const float a = 0.37f * static_cast<float>(k) + phase;
    const float r = 3 + std::sin(3 * a);
    points.push_back({r * std::cos(a), r * std::sin(a), 0.5f * std::sin(0.11f * a)});
  }
  return points;
}

TEST(Octree, AgreesWithOctoMapsOwnInsertion) {
  std::vector<Observation> observations;
  octomap::OcTree expected(kResolution);
  for (int k = 0; k < 6; ++k) {
    const auto points = wavy_points(400, 0.1f * static_cast<float>(k));
    observations.push_back(observation_of(points));
    octomap::Pointcloud cloud;
    for (const auto& p : points) cloud.push_back(p.x(), p.y(), p.z());
    expected.insertPointCloud(cloud, octomap::point3d(0, 0, 0));
  }
  expected.expand();
  size_t same = 0;
  std::istringstream in(tree_of(observations, Space::se3));
  const std::unique_ptr<octomap::AbstractOcTree> read(octomap::AbstractOcTree::read(in));
  const auto* tree = dynamic_cast<octomap::OcTree*>(read.get());
  ASSERT_NE(tree, nullptr);
  for (auto leaf = expected.begin_leafs(); leaf != expected.end_leafs(); ++leaf) {
    const auto* node = tree->search(leaf.getKey());
    same += node && node->getLogOdds() == leaf->getLogOdds() ? 1 : 0;
  }
  EXPECT_GT(expected.getNumLeafNodes(), 10000u);
  // Rounding decides otherwise where a ray passes an edge of a cell.
  EXPECT_GE(static_cast<double>(same), 0.999 * static_cast<double>(expected.getNumLeafNodes()));
}

TEST(Octree, SameBytesEachTimeAndReadableAsBt) {
  const auto observations = std::vector{observation_of(wavy_points(100, 0))};
  const std::string ot = tree_of(observations);
  EXPECT_EQ(ot, tree_of(observations));
  const std::string bt = octree_to_bt(ot);
  std::istringstream in(bt);
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary(in));
  EXPECT_EQ(tree.getResolution(), kResolution);
  EXPECT_GT(tree.getNumLeafNodes(), 50u);
}

TEST(Octree, RefusesDamagedBytes) {
  const std::string ot = tree_of({observation_of(wavy_points(20, 0))});
  for (size_t size = 0; size < ot.size(); size += 7)
    EXPECT_THROW(octree_cells(ot.substr(0, size)), InputError) << size;
  EXPECT_THROW(octree_cells(ot + "x"), InputError);
}

TEST(Octree, RefusesAResolutionOutOfRange) {
  const ObservationVector store({});
  for (const double resolution : {0.0, -1.0, 20.0, std::nan("")})
    EXPECT_THROW(build_octree({}, store, Space::se2, {resolution}), InputError);
}

}  // namespace
}  // namespace hmt::submap
