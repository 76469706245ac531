// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace hmt::submap {

/// How well a point of the plane agrees with a map of surfaces, as a grid, with the pyramid of
/// maxima that branch and bound needs [Olson 2009; Hess 2016, Sec. V-B]. Immutable once built; safe
/// to share between threads.
class CorrelativeGrid {
 public:
  /// A cell's value is exp(-d^2 / (2 sigma_m^2)) of the distance d from the cell's center to the
  /// nearest map point, in steps of 1/255; zero beyond three sigma. `levels` >= 0: the highest
  /// level of `bound`. No points give a grid that is zero everywhere.
  CorrelativeGrid(std::span<const Eigen::Vector2f> points_map, double cell_m, double sigma_m,
                  int levels);

  double cell_m() const { return cell_m_; }
  int levels() const { return static_cast<int>(pyramid_.size()) - 1; }

  /// Cell (column, row) that holds a point of the map frame; may lie outside the grid.
  Eigen::Vector2i cell(const Eigen::Vector2d& p_map) const;
  /// Largest value of the 2^level x 2^level cells whose lowest one is (x, y); zero where the grid
  /// holds none of them.
  int bound(int level, int x, int y) const {
    if (static_cast<unsigned>(x) >= static_cast<unsigned>(width_) ||
        static_cast<unsigned>(y) >= static_cast<unsigned>(height_))
      return 0;
    return pyramid_[static_cast<size_t>(level)]
                   [static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
  }
  /// Value of the cell that holds the point, in [0, 1].
  double value(const Eigen::Vector2d& p_map) const;

 private:
  void draw(std::span<const Eigen::Vector2f> points_map, double sigma_m);
  void build_pyramid(int levels);

  double cell_m_;
  Eigen::Vector2d origin_map_ = Eigen::Vector2d::Zero();  ///< lowest corner of cell (0, 0)
  int width_ = 0;
  int height_ = 0;
  std::vector<std::vector<uint8_t>> pyramid_;
};

}  // namespace hmt::submap
