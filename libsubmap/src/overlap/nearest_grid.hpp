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
  struct Cell {
    /// No target has a smaller power distance to a place in the cell, or within margin_m() of it,
    /// as long as it is below max_reach().
    float bound = 0;
    int nearest = -1;  ///< index of a target, that of least power distance to the cell's centre
  };

  /// Covers the targets; the memory of the last ones is used again. Linear in the points and cells.
  void rebuild(const SensedPoints& targets);

  /// Bounds hold for queries of no larger reach (d^2 times the variance besides the target's).
  float max_reach() const { return max_reach_; }
  float margin_m() const { return margin_m_; }

  const Cell& at(const Eigen::Vector3f& place) const {
    const Eigen::Vector3f scaled = (place - origin_) * cells_per_m_;
    // Written so that it is false for what is not a number.
    const bool inside = scaled.x() >= 0 && scaled.y() >= 0 && scaled.z() >= 0 &&
                        scaled.x() < limit_.x() && scaled.y() < limit_.y() &&
                        scaled.z() < limit_.z();
    if (!inside) return outside_;
    return cells_[index(static_cast<int>(scaled.x()), static_cast<int>(scaled.y()),
                        static_cast<int>(scaled.z()))];
  }

 private:
  size_t index(int x, int y, int z) const {
    return (static_cast<size_t>(z) * static_cast<size_t>(size_[1]) + static_cast<size_t>(y)) *
               static_cast<size_t>(size_[0]) +
           static_cast<size_t>(x);
  }
  void choose_cells(const SensedPoints& targets);
  void insert(int target, const SensedPoint& point);

  float max_reach_ = 0;
  float margin_m_ = 0;
  float cell_m_ = 1;
  float cells_per_m_ = 1;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f limit_ = Eigen::Vector3f::Zero();  ///< size_ as numbers of the same kind
  std::array<int, 3> size_{0, 0, 0};
  std::vector<Cell> cells_;
  std::vector<float> center_distance_;  ///< power distance of each cell's centre to its nearest
  Cell outside_;
};

}  // namespace hmt::submap
