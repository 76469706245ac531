// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "sensor_index.hpp"

namespace hmt::submap {

/// Consecutive keyframes that are compared with those of another block at a time.
struct Block {
  int begin = 0;
  int end = 0;

  int size() const { return end - begin; }
};

/// Upper bounds of the matches of one keyframe, for each sensor.
using KeyframeBounds = std::vector<std::vector<MatchBound>>;

/// All keyframes in blocks such that the points and the pairs of two blocks take some 75 MB; a
/// block begins with `first`. `index`: one a sensor.
std::vector<Block> blocks_of(const std::vector<SensorIndex>& index, int num_keyframes, int first);

/// Whether any keyframe with these bounds may match one of the block.
bool meet(const std::vector<KeyframeBounds>& bounds, const Block& block);

/// One number for each keyframe of the bounds, each sensor and each keyframe of the block.
std::vector<int> table(const std::vector<KeyframeBounds>& bounds, size_t num_sensors,
                       const Block& block);

}  // namespace hmt::submap
