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
    std::optional<int> size;  ///< number of its elements; nothing where there is no reading
    std::vector<CellCount> cells;
    std::vector<LandmarkPlace> landmarks;
  };
  static Entry entry(const SensedReading& reading, const OverlapOptions& options);

  /// One entry for each keyframe.
  SensorIndex(std::vector<Entry> entries, const OverlapOptions& options);

  /// Number of points or landmarks of the keyframe's reading; nothing where it has none.
  std::optional<int> size(int keyframe) const { return sizes_[static_cast<size_t>(keyframe)]; }
  /// How many of the elements of the keyframe can match one of each other keyframe, at most;
  /// keyframes that cannot match are left out.
  std::vector<MatchBound> bounds(int keyframe) const;

 private:
  std::vector<std::optional<int>> sizes_;
  CellIndex points_;
  std::optional<LandmarkIndex> landmarks_;
};

}  // namespace hmt::submap
