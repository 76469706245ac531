// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "cell_index.hpp"
#include "keyframe_space.hpp"
#include "landmark_index.hpp"

namespace hmt::submap {

/// Finds the keyframes whose readings of one sensor meet, and bounds their matches from above.
class SensorIndex {
 public:
  /// What the index needs of the reading of one keyframe.
  struct Entry {
    std::optional<double> size;     ///< number of its elements; nothing without a reading
    double memory = 0;              ///< of the reading when prepared, in points of a scan
    std::vector<CellCount> cells;   ///< of points
    std::vector<CellCount> blocks;  ///< of voxels
    std::vector<LandmarkPlace> landmarks;
  };
  static Entry entry(const SensedReading& reading, const OverlapOptions& options);

  /// One entry for each keyframe.
  SensorIndex(std::vector<Entry> entries, const OverlapOptions& options);

  /// Number of elements of the keyframe's reading; nothing where it has none.
  std::optional<double> size(int keyframe) const { return sizes_[static_cast<size_t>(keyframe)]; }
  double memory(int keyframe) const { return memory_[static_cast<size_t>(keyframe)]; }
  /// How many of the elements of the keyframe can match one of each other keyframe, at most;
  /// keyframes that cannot match are left out.
  std::vector<MatchBound> bounds(int keyframe) const;

 private:
  std::vector<std::optional<double>> sizes_;
  std::vector<double> memory_;
  CellIndex points_;
  std::optional<VoxelIndex> voxels_;
  std::optional<LandmarkIndex> landmarks_;
};

}  // namespace hmt::submap
