// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace hmt::submap {

/// Raster over the plane of how near a surface is, exp(-d^2 / (2 s^2)) in steps of 1/255, and the
/// same pooled twice: the maximum over the 4 x 4, and over the 16 x 16 cells from each cell on.
class LikelihoodGrid {
 public:
  static constexpr double kCell_m = 0.05;
  static constexpr int kPool = 4;
  static constexpr int kLevels = 3;

  /// Covers the square of half side `reach_m` around `center`; 0 beyond it.
  LikelihoodGrid(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& center,
                 double reach_m);

  /// Cell of a point; may lie outside.
  Eigen::Array2i cell_of(const Eigen::Vector2d& p) const;
  /// Upper bound of the values of cell + {0..side(level)-1}^2; the value of the cell at level 0.
  int bound(int level, const Eigen::Array2i& cell) const {
    if (static_cast<unsigned>(cell.x()) >= static_cast<unsigned>(size_) ||
        static_cast<unsigned>(cell.y()) >= static_cast<unsigned>(size_))
      return 0;
    return values_[static_cast<size_t>(level)]
                  [static_cast<size_t>(cell.y()) * static_cast<size_t>(size_) +
                   static_cast<size_t>(cell.x())];
  }
  static constexpr int side(int level) { return level == 0 ? 1 : kPool * side(level - 1); }

 private:
  void stamp(const Eigen::Vector2d& p);
  void pool(int level);

  Eigen::Vector2d low_;
  int size_ = 0;
  std::array<std::vector<uint8_t>, kLevels> values_;
};

}  // namespace hmt::submap
