// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sensed_voxels.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

namespace hmt::submap {
namespace {

constexpr float kSide_m = SensedVoxels::kSide_m;
// The index knows blocks of so many voxels along each axis: few entries, and still small against
// what a lidar sees.
constexpr int kBlockVoxels = 4;

/// A point and the voxel whose middle is the lower corner of the cube of middles about it.
struct CornerPoint {
  uint64_t corner = 0;
  Eigen::Vector3f beyond;  ///< from that middle, in sides of a voxel, [0, 1]
};

CornerPoint corner_point(const Eigen::Vector3f& p) {
  const Eigen::Vector3f scaled = p / kSide_m;
  const Eigen::Vector3f low = scaled.array().floor();
  return {
      cell_key({static_cast<int>(low.x()), static_cast<int>(low.y()), static_cast<int>(low.z())}),
      scaled - low};
}

/// For each of the 8 middles about a point, the share of their voxel that it occupies.
void raise_shares(const Eigen::Vector3f& beyond, std::array<float, 8>& shares) {
  for (size_t corner = 0; corner < 8; ++corner) {
    float share = 1;
    for (size_t axis = 0; axis < 3; ++axis) {
      const float x = beyond[static_cast<Eigen::Index>(axis)];
      share *= ((corner >> axis) & 1U) != 0 ? x : 1 - x;
    }
    shares[corner] = std::max(shares[corner], share);
  }
}

Eigen::Vector3d middle_of(uint64_t key) {
  const auto [x, y, z] = cell_coordinates(key);
  return static_cast<double>(kSide_m) * Eigen::Vector3d(x, y, z);
}

}  // namespace

SensedVoxels::SensedVoxels(const Reading& reading, const Pose& T_frame_robot) {
  const Pose T_frame_sensor = T_frame_robot * reading.T_robot_sensor;
  const Eigen::Matrix3d R = T_frame_sensor.rotation_matrix();
  std::vector<CornerPoint> points;
  points.reserve(reading.points_sensor.size());
  for (const Eigen::Vector3f& p : reading.points_sensor) {
    if (!p.allFinite()) continue;
    points.push_back(
        corner_point((T_frame_sensor.translation + R * p.cast<double>()).cast<float>()));
  }
  std::sort(points.begin(), points.end(),
            [](const CornerPoint& a, const CornerPoint& b) { return a.corner < b.corner; });
  std::vector<Voxel> all;
  for (auto point = points.begin(); point != points.end();) {
    const uint64_t key = point->corner;
    std::array<float, 8> shares{};
    for (; point != points.end() && point->corner == key; ++point) {
      raise_shares(point->beyond, shares);
    }
    const auto [x, y, z] = cell_coordinates(key);
    for (int corner = 0; corner < 8; ++corner) {
      const float share = shares[static_cast<size_t>(corner)];
      if (share <= 0) continue;
      all.push_back(
          {cell_key({x + (corner & 1), y + ((corner >> 1) & 1), z + ((corner >> 2) & 1)}), share});
    }
  }
  std::sort(all.begin(), all.end(), [](const Voxel& a, const Voxel& b) { return a.key < b.key; });
  for (const Voxel& voxel : all) {
    if (voxels_.empty() || voxels_.back().key != voxel.key) {
      voxels_.push_back(voxel);
    } else {
      voxels_.back().share = std::max(voxels_.back().share, voxel.share);
    }
  }
  voxels_.shrink_to_fit();
  for (const Voxel& voxel : voxels_) size_ += static_cast<double>(voxel.share);
}

std::vector<CellCount> SensedVoxels::blocks() const {
  std::vector<SensedPoint> middles;
  middles.reserve(voxels_.size());
  for (const Voxel& voxel : voxels_) middles.push_back({middle_of(voxel.key).cast<float>(), 0});
  return count_cells(middles, kBlockVoxels * kSide_m);
}

double common_voxels(const SensedVoxels& a, const SensedVoxels& b, const PoseSpread& spread,
                     const OverlapOptions& options) {
  const double limit = options.max_pose_deviation_m * options.max_pose_deviation_m;
  double common = 0;
  auto i = a.voxels().begin(), j = b.voxels().begin();
  while (i != a.voxels().end() && j != b.voxels().end()) {
    if (i->key == j->key) {
      if (spread.trace(middle_of(i->key)) <= limit) {
        common += static_cast<double>(std::min(i->share, j->share));
      }
      ++i;
      ++j;
    } else if (i->key < j->key) {
      ++i;
    } else {
      ++j;
    }
  }
  return common;
}

VoxelIndex::VoxelIndex(std::vector<std::vector<CellCount>> readings)
    : readings_(std::move(readings)) {
  std::vector<std::pair<uint64_t, int>> entries;
  for (int reading = 0; reading < static_cast<int>(readings_.size()); ++reading) {
    for (const CellCount& block : readings_[static_cast<size_t>(reading)]) {
      entries.emplace_back(block.cell, reading);
    }
  }
  std::sort(entries.begin(), entries.end());
  for (const auto& [key, reading] : entries) {
    if (blocks_.empty() || blocks_.back().key != key) blocks_.push_back({key, {}});
    append(blocks_.back().inside, reading);
  }
}

void VoxelIndex::add_matches(int reading, BoundSum& sum) const {
  // Both are sorted by key.
  auto block = blocks_.begin();
  for (const CellCount& own : readings_[static_cast<size_t>(reading)]) {
    block = std::lower_bound(block, blocks_.end(), own.cell,
                             [](const Block& b, uint64_t key) { return b.key < key; });
    sum.add(block->inside, own.points);
  }
}

}  // namespace hmt::submap
