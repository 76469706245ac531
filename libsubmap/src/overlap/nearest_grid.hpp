// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "sensed_points.hpp"

namespace hmt::submap {

/// Answers at once, for most places, whether any target is within the gate: cells over the targets,
/// each with a target that is near and a bound on how near any target can be. "Near" is the power
/// distance |x - target|^2 - gate of the target, since a target of a wide gate reaches farther. It
/// only saves time: what it leaves open is searched in the tree.
class NearestGrid {
 public:
  /// Covers the targets; the memory of the last ones is used again. Linear in the points and cells.
  void rebuild(const SensedPoints& targets);

  /// No target has a smaller power distance to a place in the box.
  float bound(const Eigen::AlignedBox3f& box) const { return least(box, 1, size_, bound_); }
  /// The same, looser but quicker for a large box.
  float coarse_bound(const Eigen::AlignedBox3f& box) const {
    return least(box, kCoarse, coarse_size_, coarse_bound_);
  }
  /// Index of a target that is near the place; -1 where none is.
  int nearest(const Eigen::Vector3f& place) const {
    const Eigen::Vector3f scaled = (place - origin_).cwiseProduct(cells_per_m_);
    // Written so that it is false for what is not a number.
    const bool inside = scaled.x() >= 0 && scaled.y() >= 0 && scaled.z() >= 0 &&
                        scaled.x() < limit_.x() && scaled.y() < limit_.y() &&
                        scaled.z() < limit_.z();
    if (!inside) return -1;
    return nearest_[index(static_cast<int>(scaled.x()), static_cast<int>(scaled.y()),
                          static_cast<int>(scaled.z()))];
  }

 private:
  /// Cells of the coarse grid are so many times as wide.
  static constexpr int kCoarse = 4;
  /// The level of a bound of max_reach_.
  static constexpr uint8_t kLevels = 255;

  /// The least bound of the cells that the box touches, at most max_reach_: what lies outside is at
  /// least as far from all targets as targets are entered.
  float least(const Eigen::AlignedBox3f& box, int step, const std::array<int, 3>& size,
              const std::vector<uint8_t>& bounds) const {
    std::array<int, 3> first, last;
    for (size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<Eigen::Index>(a);
      const float low = (box.min()[axis] - origin_[axis]) * cells_per_m_[axis];
      const float high = (box.max()[axis] - origin_[axis]) * cells_per_m_[axis];
      if (high < 0 || low >= limit_[axis]) return max_reach_;
      first[a] = static_cast<int>(std::max(low, 0.0F)) / step;
      last[a] = std::min(static_cast<int>(std::min(high, limit_[axis])) / step, size[a] - 1);
    }
    uint8_t bound = kLevels;
    for (int z = first[2]; z <= last[2]; ++z) {
      for (int y = first[1]; y <= last[1]; ++y) {
        const size_t row = index(0, y, z, size);
        for (int x = first[0]; x <= last[0]; ++x) {
          bound = std::min(bound, bounds[row + static_cast<size_t>(x)]);
        }
      }
    }
    return static_cast<float>(bound) * level_m2_;
  }
  static size_t index(int x, int y, int z, const std::array<int, 3>& size) {
    return (static_cast<size_t>(z) * static_cast<size_t>(size[1]) + static_cast<size_t>(y)) *
               static_cast<size_t>(size[0]) +
           static_cast<size_t>(x);
  }
  size_t index(int x, int y, int z) const { return index(x, y, z, size_); }
  void choose_cells(const SensedPoints& targets);
  void insert(const SensedPoints::Leaf& leaf, int target, const SensedPoint& point);
  void round_bounds();
  /// Enters a target into cells from `at` on along x; center, gap: square distances along y and z,
  /// less the gate.
  void fill_row(size_t at, size_t columns, int target, float center, float gap);

  float max_reach_ = 0;  ///< targets are entered where their power distance is below it
  Eigen::Vector3f cell_m_ = Eigen::Vector3f::Ones();  ///< sides of a cell
  Eigen::Vector3f cells_per_m_ = Eigen::Vector3f::Ones();
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f limit_ = Eigen::Vector3f::Zero();  ///< size_ as numbers of the same kind
  std::array<int, 3> size_{0, 0, 0};
  // Bounds of the cells in steps of level_m2_, rounded down, so that many fit into the processor's
  // cache.
  std::vector<uint8_t> bound_;
  std::array<int, 3> coarse_size_{0, 0, 0};
  std::vector<uint8_t> coarse_bound_;
  float level_m2_ = 0;
  std::vector<int> nearest_;
  // While targets are entered: the bounds as they are, and the power distance of each cell's centre
  // to its nearest.
  std::vector<float> exact_bound_;
  std::vector<float> center_distance_;
  // Of the leaf being entered, for each column of cells: square distance along x from its centre,
  // and the least one from the cell.
  std::vector<float> column_center_;
  std::vector<float> column_gap_;
};

}  // namespace hmt::submap
