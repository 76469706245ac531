// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "point_grid.hpp"

#include <algorithm>

namespace hmt::submap {
namespace {

// Cells are numbered within +-2^20 of the origin; coordinates beyond are clamped to the rim.
constexpr double kRim = 1048575.0;

}  // namespace

PointGrid::PointGrid(std::span<const Eigen::Vector3d> points, double cell_m)
    : cell_m_(cell_m), inverse_cell_(1 / cell_m) {
  size_t capacity = 16;
  while (capacity < 2 * points.size()) capacity *= 2;
  mask_ = capacity - 1;
  slots_.resize(capacity);
  if (points.empty()) return;
  low_ = high_ = cell_of(points[0]);
  std::vector<uint64_t> keys;
  keys.reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    const Cell cell = cell_of(p);
    for (size_t i = 0; i < 3; ++i) {
      low_[i] = std::min(low_[i], cell[i]);
      high_[i] = std::max(high_[i], cell[i]);
    }
    keys.push_back(key_of(cell[0], cell[1], cell[2]));
  }
  count_cells(keys);
}

// Counting sort of the points by cell, cells in order of their first point.
void PointGrid::count_cells(std::span<const uint64_t> keys) {
  std::vector<size_t> first_slots;
  for (const uint64_t key : keys) {
    const size_t s = slot_of(key);
    if (slots_[s].key == kFree) {
      slots_[s].key = key;
      first_slots.push_back(s);
    }
    ++slots_[s].end;
  }
  uint32_t begin = 0;
  for (const size_t s : first_slots) {
    const uint32_t count = slots_[s].end;
    slots_[s].begin = slots_[s].end = begin;
    begin += count;
  }
  order_.resize(keys.size());
  for (size_t i = 0; i < keys.size(); ++i)
    order_[slots_[slot_of(keys[i])].end++] = static_cast<uint32_t>(i);
}

PointGrid::Cell PointGrid::cell_of(const Eigen::Vector3d& p) const {
  Cell cell{};
  for (int i = 0; i < 3; ++i)
    cell[static_cast<size_t>(i)] =
        static_cast<int>(std::clamp(std::floor(p[i] * inverse_cell_), -kRim, kRim));
  return cell;
}

uint64_t PointGrid::key_of(int x, int y, int z) {
  const auto part = [](int v) { return static_cast<uint64_t>(v + (1 << 20)); };
  return (part(x) << 42) | (part(y) << 21) | part(z);
}

size_t PointGrid::slot_of(uint64_t key) const {
  size_t s = static_cast<size_t>((key * 0x9E3779B97F4A7C15ULL) >> 20) & mask_;
  while (slots_[s].key != kFree && slots_[s].key != key) s = (s + 1) & mask_;
  return s;
}

}  // namespace hmt::submap
