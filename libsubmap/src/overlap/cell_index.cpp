// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cell_index.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

// Cells are numbered from the middle of 21 bits an axis: +-1000 km.
constexpr int kAxisBits = 21;
constexpr int kMiddle = 1 << (kAxisBits - 1);

CellCoordinates cell_at(const Eigen::Vector3f& p, float cell_m) {
  const auto axis = [cell_m](float x) {
    return static_cast<int>(std::clamp(std::floor(x / cell_m), -1.0F * kMiddle, 1.0F * kMiddle));
  };
  return {axis(p.x()), axis(p.y()), axis(p.z())};
}

/// Least square distance of points of two cells whose numbers differ by so much.
float square_gap(int dx, int dy, int dz, float cell_m) {
  const auto gap = [cell_m](int d) {
    return cell_m * static_cast<float>(std::max(0, std::abs(d) - 1));
  };
  return gap(dx) * gap(dx) + gap(dy) * gap(dy) + gap(dz) * gap(dz);
}

}  // namespace

uint64_t cell_key(const CellCoordinates& cell) {
  uint64_t key = 0;
  for (const int axis : cell) {
    key =
        (key << kAxisBits) | static_cast<uint64_t>(std::clamp(axis + kMiddle, 0, 2 * kMiddle - 1));
  }
  return key;
}

CellCoordinates cell_coordinates(uint64_t key) {
  const auto axis = [key](int shift) {
    return static_cast<int>((key >> shift) & ((1U << kAxisBits) - 1)) - kMiddle;
  };
  return {axis(2 * kAxisBits), axis(kAxisBits), axis(0)};
}

std::vector<CellCount> count_cells(std::span<const SensedPoint> points, float cell_m) {
  std::vector<CellCount> all;
  all.reserve(points.size());
  for (const SensedPoint& p : points)
    all.push_back({cell_key(cell_at(p.position, cell_m)), 1, p.gate});
  std::sort(all.begin(), all.end(),
            [](const CellCount& a, const CellCount& b) { return a.cell < b.cell; });
  std::vector<CellCount> cells;
  for (const CellCount& one : all) {
    if (cells.empty() || cells.back().cell != one.cell) {
      cells.push_back(one);
      continue;
    }
    cells.back().points += 1;
    cells.back().gate = std::max(cells.back().gate, one.gate);
  }
  return cells;
}

CellIndex::CellIndex(std::vector<std::vector<CellCount>> readings, float cell_m,
                     double pose_gate_m2)
    : readings_(std::move(readings)), cell_m_(cell_m) {
  collect_cells();
  find_near(pose_gate_m2);
}

void CellIndex::collect_cells() {
  struct Entry {
    uint64_t key;
    int reading;
    float gate;
  };
  std::vector<Entry> entries;
  for (int reading = 0; reading < static_cast<int>(readings_.size()); ++reading) {
    for (const CellCount& c : readings_[static_cast<size_t>(reading)]) {
      entries.push_back({c.cell, reading, c.gate});
    }
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.key < b.key; });
  for (const Entry& entry : entries) {
    if (cells_.empty() || cells_.back().key != entry.key) cells_.push_back({entry.key, 0, {}, {}});
    Cell& cell = cells_.back();
    cell.gate = std::max(cell.gate, entry.gate);
    append(cell.inside, entry.reading);
  }
}

void CellIndex::find_near(double pose_gate_m2) {
  // Each pair of near cells is found from the one of the larger gate.
  for (Cell& cell : cells_) {
    const float reach = std::sqrt(2 * cell.gate + static_cast<float>(pose_gate_m2));
    const int steps = 1 + static_cast<int>(std::floor(reach / cell_m_));
    const auto [x, y, z] = cell_coordinates(cell.key);
    for (int dx = -steps; dx <= steps; ++dx) {
      for (int dy = -steps; dy <= steps; ++dy) {
        link_column(cell, {x + dx, y + dy, z - steps}, {x + dx, y + dy, z + steps}, pose_gate_m2);
      }
    }
  }
  for (Cell& cell : cells_) cell.near = join(std::move(cell.near));
}

void CellIndex::link_column(Cell& cell, const CellCoordinates& first, const CellCoordinates& last,
                            double pose_gate_m2) {
  const auto [x, y, z] = cell_coordinates(cell.key);
  const uint64_t last_key = cell_key(last);
  auto other = std::lower_bound(cells_.begin(), cells_.end(), cell_key(first),
                                [](const Cell& c, uint64_t key) { return c.key < key; });
  for (; other != cells_.end() && other->key <= last_key; ++other) {
    if (other->gate > cell.gate) continue;
    const auto [ox, oy, oz] = cell_coordinates(other->key);
    const float reach = cell.gate + other->gate + static_cast<float>(pose_gate_m2);
    if (square_gap(x - ox, y - oy, z - oz, cell_m_) > reach) continue;
    cell.near.insert(cell.near.end(), other->inside.begin(), other->inside.end());
    if (other->gate < cell.gate) {
      other->near.insert(other->near.end(), cell.inside.begin(), cell.inside.end());
    }
  }
}

void CellIndex::add_matches(int reading, BoundSum& sum) const {
  for (const CellCount& count : readings_[static_cast<size_t>(reading)]) {
    const auto cell = std::lower_bound(cells_.begin(), cells_.end(), count.cell,
                                       [](const Cell& c, uint64_t key) { return c.key < key; });
    sum.add(cell->near, count.points);
  }
}

}  // namespace hmt::submap
