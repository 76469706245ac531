// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace hmt::submap {

/// Points hashed into cubic cells for searches within a radius. Points of a cell are visited in
/// increasing order of index, cells in a fixed order, so every walk is deterministic.
class PointGrid {
 public:
  PointGrid() = default;
  PointGrid(std::span<const Eigen::Vector3d> points, double cell_m);

  /// Calls visit(index) for every point in the cells that a cube of half side `radius_m` around p
  /// touches: all points within the radius and some more.
  template <class Visit>
  void visit_near(const Eigen::Vector3d& p, double radius_m, const Visit& visit) const;

  /// The same for a search of the nearest: visit(index) returns the squared distance beyond which
  /// nothing is wanted any more, radius2_m2 at first. The point's own cell comes first, and cells
  /// that lie beyond are left out.
  template <class Visit>
  void visit_nearer(const Eigen::Vector3d& p, double radius2_m2, const Visit& visit) const;

 private:
  struct Slot {
    uint64_t key = kFree;
    uint32_t begin = 0;
    uint32_t end = 0;
  };
  static constexpr uint64_t kFree = ~uint64_t{0};

  using Cell = std::array<int, 3>;
  /// Squared distance along one axis from a coordinate to a layer of cells.
  double gap2(double coordinate, int layer) const {
    const double low_m = layer * cell_m_;
    const double gap_m = std::max({low_m - coordinate, coordinate - low_m - cell_m_, 0.0});
    return gap_m * gap_m;
  }
  Cell cell_of(const Eigen::Vector3d& p) const;
  static uint64_t key_of(int x, int y, int z);
  size_t slot_of(uint64_t key) const;
  void count_cells(std::span<const uint64_t> keys);

  double cell_m_ = 1;
  double inverse_cell_ = 1;
  size_t mask_ = 0;
  Cell low_{0, 0, 0};
  Cell high_{-1, -1, -1};
  std::vector<Slot> slots_;
  std::vector<uint32_t> order_;
};

template <class Visit>
void PointGrid::visit_near(const Eigen::Vector3d& p, double radius_m, const Visit& visit) const {
  if (order_.empty()) return;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius_m);
  Cell low = cell_of(p - reach), high = cell_of(p + reach);
  for (size_t i = 0; i < 3; ++i) {
    low[i] = std::max(low[i], low_[i]);
    high[i] = std::min(high[i], high_[i]);
  }
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x) {
        const Slot& slot = slots_[slot_of(key_of(x, y, z))];
        for (uint32_t i = slot.begin; i < slot.end; ++i) visit(static_cast<size_t>(order_[i]));
      }
}

template <class Visit>
void PointGrid::visit_nearer(const Eigen::Vector3d& p, double radius2_m2,
                             const Visit& visit) const {
  if (order_.empty()) return;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(std::sqrt(radius2_m2));
  Cell low = cell_of(p - reach), high = cell_of(p + reach);
  for (size_t i = 0; i < 3; ++i) {
    low[i] = std::max(low[i], low_[i]);
    high[i] = std::min(high[i], high_[i]);
  }
  double limit2 = radius2_m2;
  const auto visit_cell = [&](int x, int y, int z) {
    const Slot& slot = slots_[slot_of(key_of(x, y, z))];
    for (uint32_t i = slot.begin; i < slot.end; ++i) limit2 = visit(static_cast<size_t>(order_[i]));
  };
  const Cell own = cell_of(p);
  visit_cell(own[0], own[1], own[2]);
  for (int z = low[2]; z <= high[2]; ++z) {
    const double gap_z2 = gap2(p.z(), z);
    for (int y = low[1]; y <= high[1]; ++y) {
      const double gap_zy2 = gap_z2 + gap2(p.y(), y);
      if (gap_zy2 > limit2) continue;
      for (int x = low[0]; x <= high[0]; ++x)
        if (gap_zy2 + gap2(p.x(), x) <= limit2 && Cell{x, y, z} != own) visit_cell(x, y, z);
    }
  }
}

}  // namespace hmt::submap
