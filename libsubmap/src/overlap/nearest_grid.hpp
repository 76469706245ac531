// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
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

  /// What is known of a place.
  struct Place {
    float bound = 0;   ///< no target has a smaller power distance to it
    int nearest = -1;  ///< index of a target that is near; -1 where none is
  };
  Place at(const Eigen::Vector3f& place) const {
    const Eigen::Vector3f scaled = (place - origin_).cwiseProduct(cells_per_m_);
    // Written so that it is false for what is not a number.
    const bool inside = scaled.x() >= 0 && scaled.y() >= 0 && scaled.z() >= 0 &&
                        scaled.x() < limit_.x() && scaled.y() < limit_.y() &&
                        scaled.z() < limit_.z();
    // What lies outside is at least as far from all targets as targets are entered.
    if (!inside) return {max_reach_, -1};
    const size_t cell = index(static_cast<int>(scaled.x()), static_cast<int>(scaled.y()),
                              static_cast<int>(scaled.z()));
    return {bound_[cell], nearest_[cell]};
  }
  /// False if no target has a power distance of `reach` or less to a place in the box.
  bool can_reach(const Eigen::AlignedBox3f& box, float reach) const {
    if (max_reach_ <= reach) return true;
    const Eigen::Array3f low = (box.min() - origin_).cwiseProduct(cells_per_m_);
    const Eigen::Array3f high = (box.max() - origin_).cwiseProduct(cells_per_m_);
    if ((high < 0).any() || (low >= limit_.array()).any()) return false;
    const Eigen::Array3i first = low.max(0).cast<int>();
    const Eigen::Array3i last = high.min(limit_.array() - 1).cast<int>();
    for (int z = first.z(); z <= last.z(); ++z) {
      for (int y = first.y(); y <= last.y(); ++y) {
        const size_t row = index(0, y, z);
        for (int x = first.x(); x <= last.x(); ++x) {
          if (bound_[row + static_cast<size_t>(x)] <= reach) return true;
        }
      }
    }
    return false;
  }

 private:
  size_t index(int x, int y, int z) const {
    return (static_cast<size_t>(z) * static_cast<size_t>(size_[1]) + static_cast<size_t>(y)) *
               static_cast<size_t>(size_[0]) +
           static_cast<size_t>(x);
  }
  void choose_cells(const SensedPoints& targets);
  void insert(const SensedPoints::Leaf& leaf, int target, const SensedPoint& point);
  /// Enters a target into cells from `at` on along x; center, gap: square distances along y and z,
  /// less the gate.
  void fill_row(size_t at, size_t columns, int target, float center, float gap);

  float max_reach_ = 0;  ///< targets are entered where their power distance is below it
  Eigen::Vector3f cell_m_ = Eigen::Vector3f::Ones();  ///< sides of a cell
  Eigen::Vector3f cells_per_m_ = Eigen::Vector3f::Ones();
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f limit_ = Eigen::Vector3f::Zero();  ///< size_ as numbers of the same kind
  std::array<int, 3> size_{0, 0, 0};
  std::vector<float> bound_;
  std::vector<int> nearest_;
  std::vector<float> center_distance_;  ///< power distance of the cell's centre to its nearest
  // Of the leaf being entered, for each column of cells: square distance along x from its centre,
  // and the least one from the cell.
  std::vector<float> column_center_;
  std::vector<float> column_gap_;
};

}  // namespace hmt::submap
