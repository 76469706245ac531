// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cell_index.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "pose_spread.hpp"

namespace hmt::submap {

/// Readings of more points than this, on average over those that are compared, are compared by
/// voxels: point by point a pair of them would take more than some milliseconds. Of clouds fewer,
/// for sparse ones have wide gates, which reach from one surface to the next.
inline constexpr double kMaxExactPoints = 8192;
inline constexpr double kMaxExactCloud = 1024;

/// A large cloud as the voxels that it occupies: the map elements are voxels [Blanco 2009,
/// footnote 3], as wide as the gate of a point some 10 m from a spinning lidar. A voxel is occupied
/// in part: by 1 where a point lies in its middle, by 0 where none is within a voxel's width along
/// any axis, and in proportion between. So the overlap changes steadily with the pose, where whole
/// voxels would jump when a wall passes from one layer to the next.
class SensedVoxels {
 public:
  struct Voxel {
    uint64_t key = 0;
    float share = 0;  ///< (0, 1]
  };
  static constexpr float kSide_m = 0.5F;

  /// Points that are not finite are left out. Linear in the points, but for sorting.
  SensedVoxels(const Reading& reading, const Pose& T_frame_robot);

  /// By increasing key.
  std::span<const Voxel> voxels() const { return voxels_; }
  /// The sum of the shares: the number of elements.
  double size() const { return size_; }
  /// The blocks of voxels that it occupies, with the voxels in each: what an index needs.
  std::vector<CellCount> blocks() const;

 private:
  std::vector<Voxel> voxels_;
  double size_ = 0;
};

/// Elements that both sensed: the sum over the voxels of the smaller share. Voxels that the pose
/// alone moves by more than max_pose_deviation_m do not count.
double common_voxels(const SensedVoxels& a, const SensedVoxels& b, const PoseSpread& spread,
                     const OverlapOptions& options);

/// Bounds the common voxels of readings of one sensor from above: an inverted index from blocks of
/// voxels to the readings that occupy one in it, so that its cost grows with the voxels and not
/// with the pairs of readings.
class VoxelIndex {
 public:
  /// `readings[i]`: the blocks of reading i, none where there is no reading.
  explicit VoxelIndex(std::vector<std::vector<CellCount>> readings);

  /// Adds the voxels of the reading that can be common with the others.
  void add_matches(int reading, BoundSum& sum) const;

 private:
  struct Block {
    uint64_t key = 0;
    std::vector<ReadingRun> inside;
  };
  std::vector<std::vector<CellCount>> readings_;
  std::vector<Block> blocks_;  ///< by increasing key
};

}  // namespace hmt::submap
