// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sensed_voxels.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace hmt::submap {
namespace {

const PoseSpread kCertain(Pose{}, Matrix6d::Zero());

SensedVoxels voxels_of(std::vector<Eigen::Vector3f> points, const Pose& T = {}) {
  Reading reading;
  reading.points_sensor = std::move(points);
  return {reading, T};
}

double common(const SensedVoxels& a, const SensedVoxels& b, const PoseSpread& spread = kCertain) {
  return common_voxels(a, b, spread, OverlapOptions{});
}

// Voxels are 0.5 m wide; their middles lie at multiples of 0.5 m.

TEST(SensedVoxels, APointInTheMiddleOccupiesItsVoxelAlone) {
  const SensedVoxels voxels = voxels_of({{1, -2, 0.5}});
  ASSERT_EQ(voxels.voxels().size(), 1U);
  EXPECT_EQ(voxels.size(), 1.0);
  EXPECT_EQ(common(voxels, voxels), 1.0);
}

TEST(SensedVoxels, APointBetweenTwoMiddlesIsShared) {
  //   0 ....x.... 0.5     a quarter of the way: 0.75 of the first, 0.25 of the second
  const SensedVoxels between = voxels_of({{0.125F, 0, 0}});
  ASSERT_EQ(between.voxels().size(), 2U);
  EXPECT_DOUBLE_EQ(between.size(), 1.0);
  EXPECT_DOUBLE_EQ(common(between, voxels_of({{0, 0, 0}})), 0.75);
  EXPECT_DOUBLE_EQ(common(between, voxels_of({{0.5F, 0, 0}})), 0.25);
  EXPECT_DOUBLE_EQ(common(between, voxels_of({{1, 0, 0}})), 0.0);
  // Half way along all three axes: an eighth of eight voxels.
  EXPECT_EQ(voxels_of({{0.25F, 0.25F, 0.25F}}).voxels().size(), 8U);
}

TEST(SensedVoxels, ManyPointsInAVoxelOccupyItOnce) {
  const SensedVoxels voxels = voxels_of({{0, 0, 0}, {0, 0, 0}, {0.125F, 0, 0}});
  EXPECT_DOUBLE_EQ(voxels.size(), 1.25);
  EXPECT_DOUBLE_EQ(common(voxels, voxels), voxels.size());
}

TEST(SensedVoxels, LieInTheCommonFrame) {
  const SensedVoxels moved = voxels_of({{1, 0, 0}}, Pose::planar(2, 1, 0));
  EXPECT_DOUBLE_EQ(common(moved, voxels_of({{3, 1, 0}})), 1.0);
}

TEST(SensedVoxels, PlacesThatThePoseBlursDoNotCount) {
  // A heading variance of 9e-4: 0.3 m at 10 m.
  Matrix6d covariance = Matrix6d::Zero();
  covariance(5, 5) = 9e-4;
  const PoseSpread spread(Pose{}, covariance);
  const SensedVoxels voxels = voxels_of({{9.5F, 0, 0}, {10.5F, 0, 0}});
  EXPECT_DOUBLE_EQ(common(voxels, voxels, spread), 1.0);
}

TEST(SensedVoxels, LeavesOutPointsThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(voxels_of({{nan, 0, 0}}).size(), 0.0);
  EXPECT_EQ(voxels_of({{nan, 0, 0}, {0, 0, 0}}).size(), 1.0);
}

TEST(VoxelIndex, BoundsTheCommonVoxelsFromAbove) {
  const std::vector<SensedVoxels> readings = {voxels_of({{0, 0, 0}, {0.6F, 0, 0}, {9, 9, 9}}),
                                              voxels_of({{0.5F, 0, 0}}), voxels_of({{40, 0, 0}}),
                                              voxels_of({{9, 9, 9}, {-9, 0, 0}})};
  std::vector<std::vector<CellCount>> blocks;
  for (const SensedVoxels& reading : readings) blocks.push_back(reading.blocks());
  const VoxelIndex index(blocks);
  for (size_t i = 0; i < readings.size(); ++i) {
    BoundSum sum(readings.size());
    index.add_matches(static_cast<int>(i), sum);
    std::vector<int> bound(readings.size(), 0);
    for (const MatchBound& b : std::move(sum).bounds(1000)) {
      for (int j = b.begin; j < b.end; ++j) bound[static_cast<size_t>(j)] = b.matches;
    }
    for (size_t j = 0; j < readings.size(); ++j) {
      EXPECT_GE(bound[j], common(readings[i], readings[j])) << i << " " << j;
    }
    EXPECT_EQ(bound[2] > 0, i == 2) << i;
  }
}

}  // namespace
}  // namespace hmt::submap
