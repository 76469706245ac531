// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "likelihood_grid.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

constexpr double kSpread_m = 0.1;
constexpr int kStampCells = 5;  // beyond 2.5 spreads the value is below 5 %

}  // namespace

LikelihoodGrid::LikelihoodGrid(std::span<const Eigen::Vector2d> points,
                               const Eigen::Vector2d& center, double reach_m)
    : low_(center - Eigen::Vector2d::Constant(reach_m)),
      size_(static_cast<int>(std::ceil(2 * reach_m / kCell_m)) + 1) {
  values_[0].assign(static_cast<size_t>(size_) * static_cast<size_t>(size_), 0);
  for (const Eigen::Vector2d& p : points) stamp(p);
  for (int level = 1; level < kLevels; ++level) pool(level);
}

Eigen::Array2i LikelihoodGrid::cell_of(const Eigen::Vector2d& p) const {
  return ((p - low_) / kCell_m).array().floor().cast<int>();
}

void LikelihoodGrid::stamp(const Eigen::Vector2d& p) {
  const Eigen::Array2i center = cell_of(p);
  for (int y = std::max(0, center.y() - kStampCells);
       y <= std::min(size_ - 1, center.y() + kStampCells); ++y)
    for (int x = std::max(0, center.x() - kStampCells);
         x <= std::min(size_ - 1, center.x() + kStampCells); ++x) {
      const Eigen::Vector2d middle = low_ + kCell_m * Eigen::Vector2d(x + 0.5, y + 0.5);
      const double z2 = (middle - p).squaredNorm() / (kSpread_m * kSpread_m);
      const auto value = static_cast<uint8_t>(255 * std::exp(-z2 / 2));
      uint8_t& cell =
          values_[0][static_cast<size_t>(y) * static_cast<size_t>(size_) + static_cast<size_t>(x)];
      cell = std::max(cell, value);
    }
}

// Maximum over kPool cells of the level below, along x, then along y, from the low side so that it
// can be in place.
void LikelihoodGrid::pool(int level) {
  const auto n = static_cast<size_t>(size_);
  const auto step = static_cast<size_t>(side(level - 1));
  const std::vector<uint8_t>& below = values_[static_cast<size_t>(level) - 1];
  std::vector<uint8_t>& pooled = values_[static_cast<size_t>(level)];
  pooled = below;
  for (size_t y = 0; y < n; ++y)
    for (size_t k = step; k < kPool * step; k += step)
      for (size_t x = 0; x + k < n; ++x)
        pooled[y * n + x] = std::max(pooled[y * n + x], below[y * n + x + k]);
  for (size_t y = 0; y < n; ++y)
    for (size_t k = step; k < kPool * step && y + k < n; k += step)
      for (size_t x = 0; x < n; ++x)
        pooled[y * n + x] = std::max(pooled[y * n + x], pooled[(y + k) * n + x]);
}

}  // namespace hmt::submap
