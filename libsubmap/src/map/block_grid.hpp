// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

namespace hmt::submap {

/// Cell of a grid: floor(p / resolution) for each axis.
using CellIndex = Eigen::Vector3i;

/// Sparse grid over space: cells in blocks that exist where something was seen, so memory follows
/// the area seen and not its bounding box. Neighboring cells are near in memory.
template <class Cell>
class BlockGrid {
 public:
  /// The cell; made with its default value where it is not there yet.
  Cell& at(const CellIndex& index) {
    const uint64_t key = block_key(index);
    if (key != last_key_ || !last_block_) {
      std::unique_ptr<Block>& block = blocks_[key];
      if (!block) block = std::make_unique<Block>();
      last_key_ = key;
      last_block_ = block.get();
    }
    return (*last_block_)[place_in_block(index)];
  }

  /// Calls visit(index, cell) for every cell of every block; blocks in the order of (z, y, x).
  template <class Visit>
  void for_each(Visit&& visit) const {
    std::vector<uint64_t> keys;
    keys.reserve(blocks_.size());
    for (const auto& [key, block] : blocks_) keys.push_back(key);
    std::sort(keys.begin(), keys.end());
    for (const uint64_t key : keys) {
      const CellIndex corner = first_cell(key);
      const Block& block = *blocks_.at(key);
      for (int place = 0; place < kCells; ++place)
        visit(CellIndex(corner +
                        CellIndex(place % kSide, place / kSide % kSide, place / (kSide * kSide))),
              block[static_cast<size_t>(place)]);
    }
  }

 private:
  // Side and height of a block. Flat ones suit planar scans, and cost clouds little.
  static constexpr int kSide = 16;
  static constexpr int kHeight = 4;
  static constexpr int kCells = kSide * kSide * kHeight;
  // Block numbers are made positive; 21 bits for each axis.
  static constexpr int kOffset = 1 << 20;
  using Block = std::array<Cell, kCells>;

  static uint64_t block_key(const CellIndex& index) {
    const auto x = static_cast<uint64_t>((index.x() >> 4) + kOffset);
    const auto y = static_cast<uint64_t>((index.y() >> 4) + kOffset);
    const auto z = static_cast<uint64_t>((index.z() >> 2) + kOffset);
    return z << 42 | y << 21 | x;
  }
  static size_t place_in_block(const CellIndex& index) {
    return static_cast<size_t>((index.z() & 3) << 8 | (index.y() & 15) << 4 | (index.x() & 15));
  }
  static CellIndex first_cell(uint64_t key) {
    const auto number = [&](int shift) {
      return static_cast<int>(key >> shift & 0x1fffff) - kOffset;
    };
    return {number(0) * kSide, number(21) * kSide, number(42) * kHeight};
  }

  std::unordered_map<uint64_t, std::unique_ptr<Block>> blocks_;
  uint64_t last_key_ = 0;
  Block* last_block_ = nullptr;
};

}  // namespace hmt::submap
