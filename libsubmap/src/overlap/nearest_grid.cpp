// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nearest_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hmt::submap {
namespace {

// Beyond it cells are made larger instead; some 10 MB a thread.
constexpr double kMaxCells = 1 << 20;

// What the grid allows for the uncertainty of the pose.
constexpr float kPoseGate_m = 0.5F;

// A place at the edge of a cell may be rounded into its neighbour.
constexpr float kRounding_m = 1e-4F;

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
  // A cell as wide as the gate of two middling points. Queries that reach farther than most are
  // left to the tree: they would need every target to be entered in many cells.
  const float wide_gate = gate_quantile(targets, 0.98);
  max_reach_ = 2 * wide_gate + kPoseGate_m * kPoseGate_m;
  const Eigen::AlignedBox3f& box = targets.nodes().front().box;
  const float border = std::sqrt(max_reach_ + targets.nodes().front().gate);
  origin_ = box.min().array() - border;
  const Eigen::Array3f width = box.sizes().array() + 2 * border;
  float side = 1.0F * std::sqrt(2 * gate_quantile(targets, 0.5));
  do {
    // Where the targets are flat, as scans are along z, one cell is as good as many.
    const auto flat = box.sizes().array() < side;
    limit_ = flat.select(1, (width / side).floor() + 1).matrix();
    cell_m_ = flat.select(width * 1.001F, side).matrix();
    side *= 1.5F;
  } while (limit_.cast<double>().prod() > kMaxCells);
  cells_per_m_ = cell_m_.cwiseInverse();
  for (size_t axis = 0; axis < 3; ++axis) {
    size_[axis] = static_cast<int>(limit_[static_cast<Eigen::Index>(axis)]);
  }
}

void NearestGrid::rebuild(const SensedPoints& targets) {
  limit_.setZero();
  max_reach_ = 0;
  if (targets.size() == 0) return;
  choose_cells(targets);
  const size_t count = index(0, 0, size_[2]);
  bound_.assign(count, max_reach_);
  center_distance_.assign(count, std::numeric_limits<float>::max());
  nearest_.assign(count, -1);
  column_center_.resize(static_cast<size_t>(size_[0]));
  column_gap_.resize(static_cast<size_t>(size_[0]));
  for (const SensedPoints::Leaf& leaf : targets.leaves()) {
    const int middle = (leaf.begin + leaf.end) / 2;
    insert(leaf, middle, targets.points()[static_cast<size_t>(middle)]);
  }
}

void NearestGrid::insert(const SensedPoints::Leaf& leaf, int target, const SensedPoint& point) {
  const float reach = std::sqrt(leaf.max_gate + max_reach_);
  const Eigen::Vector3f low = (leaf.box.min() - origin_).array() - kRounding_m;
  const Eigen::Vector3f high = (leaf.box.max() - origin_).array() + kRounding_m;
  const Eigen::Vector3f place = point.position - origin_;
  std::array<int, 3> first, last;
  for (size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    first[a] = std::max(0, static_cast<int>((low[axis] - reach) * cells_per_m_[axis]));
    last[a] = std::min(size_[a] - 1, static_cast<int>((high[axis] + reach) * cells_per_m_[axis]));
  }
  // Distance along one axis of the cell's centre from the target, ...
  const auto from_center = [&](int cell, Eigen::Index axis) {
    return (static_cast<float>(cell) + 0.5F) * cell_m_[axis] - place[axis];
  };
  // ... and of the cell from the box of the leaf.
  const auto gap = [&](int cell, Eigen::Index axis) {
    const float begin = static_cast<float>(cell) * cell_m_[axis];
    return std::max({0.0F, begin - high[axis], low[axis] - begin - cell_m_[axis]});
  };
  const auto square = [](float v) { return v * v; };
  const auto columns = static_cast<size_t>(last[0] - first[0] + 1);
  for (size_t x = 0; x < columns; ++x) {
    column_center_[x] = square(from_center(first[0] + static_cast<int>(x), 0));
    column_gap_[x] = square(gap(first[0] + static_cast<int>(x), 0));
  }
  for (int z = first[2]; z <= last[2]; ++z) {
    for (int y = first[1]; y <= last[1]; ++y) {
      fill_row(index(first[0], y, z), columns, target,
               square(from_center(y, 1)) + square(from_center(z, 2)) - point.gate,
               square(gap(y, 1)) + square(gap(z, 2)) - leaf.max_gate);
    }
  }
}

void NearestGrid::fill_row(size_t at, size_t columns, int target, float center, float gap) {
  float* const bound = bound_.data() + at;
  float* const distance = center_distance_.data() + at;
  int* const nearest = nearest_.data() + at;
  const float* const column_center = column_center_.data();
  const float* const column_gap = column_gap_.data();
  for (size_t x = 0; x < columns; ++x) {
    bound[x] = std::min(bound[x], gap + column_gap[x]);
    const float own = center + column_center[x];
    nearest[x] = own < distance[x] ? target : nearest[x];
    distance[x] = std::min(distance[x], own);
  }
}

}  // namespace hmt::submap
