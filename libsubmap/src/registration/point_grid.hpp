// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
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

 private:
  struct Slot {
    uint64_t key = kFree;
    uint32_t begin = 0;
    uint32_t end = 0;
  };
  static constexpr uint64_t kFree = ~uint64_t{0};

  using Cell = std::array<int, 3>;
  Cell cell_of(const Eigen::Vector3d& p) const;
  static uint64_t key_of(int x, int y, int z);
  size_t slot_of(uint64_t key) const;
  void count_cells(std::span<const uint64_t> keys);

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

}  // namespace hmt::submap
