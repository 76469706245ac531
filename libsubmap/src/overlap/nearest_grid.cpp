// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nearest_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hmt::submap {
namespace {

constexpr float kNever = std::numeric_limits<float>::max();
// Beyond it cells are made larger instead; some 10 MB a thread.
constexpr double kMaxCells = 1 << 20;

// What the grid allows for the uncertainty of the pose.
constexpr float kPoseGate_m = 0.3F;

/// The gate that the given share of the points do not exceed.
float gate_quantile(const SensedPoints& points, double share) {
  std::vector<float> gates;
  gates.reserve(points.points().size());
  for (const SensedPoint& p : points.points()) gates.push_back(p.gate);
  const auto at = gates.begin() + static_cast<std::ptrdiff_t>(share * (points.size() - 1));
  std::nth_element(gates.begin(), at, gates.end());
  return *at;
}

}  // namespace

void NearestGrid::choose_cells(const SensedPoints& targets) {
  // A cell as wide as twice the gate of two middling points. Queries that reach farther than most
  // are left to the tree: they would need every target to be entered in many cells.
  const float wide_gate = gate_quantile(targets, 0.9);
  cell_m_ = 2 * std::sqrt(2 * gate_quantile(targets, 0.5));
  max_reach_ = 2 * wide_gate + kPoseGate_m * kPoseGate_m;
  margin_m_ = std::sqrt(wide_gate);
  const Eigen::AlignedBox3f& box = targets.nodes().front().box;
  const float border = std::sqrt(max_reach_ + targets.nodes().front().gate);
  for (bool fits = false; !fits; cell_m_ *= fits ? 1.0F : 1.5F) {
    origin_ = box.min().array() - border - margin_m_;
    const Eigen::Vector3f width = box.max() - origin_;
    double count = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const float cells = std::floor((width[axis] + border + margin_m_) / cell_m_) + 1;
      count *= static_cast<double>(cells);
      limit_[axis] = cells;
    }
    fits = count <= kMaxCells;
  }
  cells_per_m_ = 1 / cell_m_;
  for (int axis = 0; axis < 3; ++axis)
    size_[static_cast<size_t>(axis)] = static_cast<int>(limit_[axis]);
}

void NearestGrid::rebuild(const SensedPoints& targets) {
  outside_ = {kNever, -1};
  limit_.setZero();
  if (targets.size() == 0) return;
  choose_cells(targets);
  const size_t count = index(0, 0, size_[2]);
  cells_.assign(count, {kNever, -1});
  center_distance_.assign(count, kNever);
  int target = 0;
  for (const SensedPoint& p : targets.points()) insert(target++, p);
}

void NearestGrid::insert(int target, const SensedPoint& point) {
  const float reach = std::sqrt(point.gate + max_reach_);
  const Eigen::Vector3f place = point.position - origin_;
  std::array<int, 3> first, last;
  for (size_t axis = 0; axis < 3; ++axis) {
    const float x = place[static_cast<Eigen::Index>(axis)];
    first[axis] = std::max(0, static_cast<int>((x - reach - margin_m_) * cells_per_m_));
    last[axis] =
        std::min(size_[axis] - 1, static_cast<int>((x + reach + margin_m_) * cells_per_m_));
  }
  const auto center_offset = [this](int cell, float x) {
    return std::abs((static_cast<float>(cell) + 0.5F) * cell_m_ - x);
  };
  // Least distance to the cell widened by the margin, along one axis.
  const auto gap = [this](float offset) {
    return std::max(0.0F, offset - cell_m_ / 2 - margin_m_);
  };
  for (int z = first[2]; z <= last[2]; ++z) {
    const float oz = center_offset(z, place.z()), gz = gap(oz);
    for (int y = first[1]; y <= last[1]; ++y) {
      const float oy = center_offset(y, place.y()), gy = gap(oy);
      const float row_center = oz * oz + oy * oy - point.gate;
      const float row_gap = gz * gz + gy * gy - point.gate;
      const size_t row = index(0, y, z);
      for (int x = first[0]; x <= last[0]; ++x) {
        const size_t at = row + static_cast<size_t>(x);
        const float ox = center_offset(x, place.x()), gx = gap(ox);
        cells_[at].bound = std::min(cells_[at].bound, row_gap + gx * gx);
        if (row_center + ox * ox < center_distance_[at]) {
          center_distance_[at] = row_center + ox * ox;
          cells_[at].nearest = target;
        }
      }
    }
  }
}

}  // namespace hmt::submap
