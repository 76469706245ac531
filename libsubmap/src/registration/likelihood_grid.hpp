// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace hmt::submap {

/// Raster over the plane of how near a surface is, exp(-d^2 / (2 s^2)) in steps of 1/255, and the
/// same pooled: the maximum over the 4 x 4 cells from each cell on.
class LikelihoodGrid {
 public:
  static constexpr double kCell_m = 0.05;
  static constexpr int kPool = 4;

  /// Covers the square of half side `reach_m` around `center`; 0 beyond it.
  LikelihoodGrid(std::span<const Eigen::Vector2d> points, const Eigen::Vector2d& center,
                 double reach_m);

  /// Cell of a point; may lie outside.
  Eigen::Array2i cell_of(const Eigen::Vector2d& p) const;
  int fine(const Eigen::Array2i& cell) const { return at(fine_, cell); }
  /// Upper bound of fine() over cell + {0..kPool-1}^2.
  int pooled(const Eigen::Array2i& cell) const { return at(pooled_, cell); }

 private:
  int at(const std::vector<uint8_t>& values, const Eigen::Array2i& cell) const {
    if (cell.x() < 0 || cell.y() < 0 || cell.x() >= size_ || cell.y() >= size_) return 0;
    return values[static_cast<size_t>(cell.y()) * static_cast<size_t>(size_) +
                  static_cast<size_t>(cell.x())];
  }
  void stamp(const Eigen::Vector2d& p);
  void pool();

  Eigen::Vector2d low_;
  int size_ = 0;
  std::vector<uint8_t> fine_, pooled_;
};

}  // namespace hmt::submap
