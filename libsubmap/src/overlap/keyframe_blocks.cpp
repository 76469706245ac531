// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "keyframe_blocks.hpp"

#include <algorithm>

namespace hmt::submap {
namespace {

// Two blocks of consecutive keyframes are held at a time, so that memory does not grow with the
// points of the log: some 50 MB for the points and 25 MB for the pairs by these limits. Larger
// blocks would prepare keyframes less often, but compare more with each other that show the same.
constexpr int kBlockKeyframes = 512;
constexpr double kBlockPoints = 1e6;

}  // namespace

std::vector<Block> blocks_of(const std::vector<SensorIndex>& index, int num_keyframes, int first) {
  std::vector<Block> blocks;
  double points = 0;
  for (int keyframe = 0; keyframe < num_keyframes; ++keyframe) {
    double own = 0;
    for (const SensorIndex& of_sensor : index) own += of_sensor.memory(keyframe);
    points += own;
    if (blocks.empty() || keyframe == first || blocks.back().size() == kBlockKeyframes ||
        points > kBlockPoints) {
      blocks.push_back({keyframe, keyframe});
      points = own;
    }
    blocks.back().end = keyframe + 1;
  }
  return blocks;
}

bool meet(const std::vector<KeyframeBounds>& bounds, const Block& block) {
  for (const KeyframeBounds& keyframe : bounds) {
    for (const auto& sensor : keyframe) {
      for (const MatchBound& bound : sensor) {
        if (bound.begin < block.end && block.begin < bound.end) return true;
      }
    }
  }
  return false;
}

std::vector<int> table(const std::vector<KeyframeBounds>& bounds, size_t num_sensors,
                       const Block& block) {
  const size_t width = static_cast<size_t>(block.size());
  std::vector<int> table(bounds.size() * num_sensors * width, 0);
  int* row = table.data();
  for (const KeyframeBounds& keyframe : bounds) {
    for (const auto& sensor : keyframe) {
      for (const MatchBound& bound : sensor) {
        const int begin = std::max(bound.begin, block.begin), end = std::min(bound.end, block.end);
        if (begin < end)
          std::fill(row + begin - block.begin, row + end - block.begin, bound.matches);
      }
      row += width;
    }
  }
  return table;
}

}  // namespace hmt::submap
