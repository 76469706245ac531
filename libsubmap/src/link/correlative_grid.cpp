// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/correlative_grid.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

/// Cells beyond which the kernel of `draw` is zero.
int kernel_radius(double sigma_m, double cell_m) {
  return static_cast<int>(std::ceil(3.0 * sigma_m / cell_m));
}

/// out(x, y) = max(in(x, y), in(x + step, y + step), and the other two), zero outside.
std::vector<uint8_t> widen(const std::vector<uint8_t>& in, int width, int height, int step) {
  const auto w = static_cast<size_t>(width);
  const auto h = static_cast<size_t>(height);
  const auto s = static_cast<size_t>(step);
  std::vector<uint8_t> out = in;
  for (size_t y = 0; y < h; ++y) {
    const uint8_t* const from = in.data() + y * w;
    uint8_t* const to = out.data() + y * w;
    for (size_t x = 0; x + s < w; ++x) to[x] = std::max(from[x], from[x + s]);
  }
  // Row y is final before any later row reads it: rows are only read from above.
  for (size_t y = 0; y + s < h; ++y) {
    uint8_t* const to = out.data() + y * w;
    const uint8_t* const from = out.data() + (y + s) * w;
    for (size_t x = 0; x < w; ++x) to[x] = std::max(to[x], from[x]);
  }
  return out;
}

}  // namespace

CorrelativeGrid::CorrelativeGrid(std::span<const Eigen::Vector2f> points_map, double cell_m,
                                 double sigma_m, int levels)
    : cell_m_(cell_m) {
  pyramid_.resize(1);
  if (!points_map.empty()) {
    Eigen::Vector2f low = points_map.front();
    Eigen::Vector2f high = low;
    for (const Eigen::Vector2f& p : points_map) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    // Room for the kernel on all sides, and below for the windows of the highest level.
    const int radius = kernel_radius(sigma_m, cell_m);
    const int margin = radius + (1 << levels);
    // Corners of cells are whole multiples of their size in the map frame.
    origin_map_ =
        cell_m * ((low.cast<double>().array() / cell_m).floor() - static_cast<double>(margin));
    const Eigen::Vector2i last = cell(high.cast<double>());
    width_ = last.x() + radius + 1;
    height_ = last.y() + radius + 1;
    draw(points_map, sigma_m);
  }
  build_pyramid(levels);
}

Eigen::Vector2i CorrelativeGrid::cell(const Eigen::Vector2d& p_map) const {
  const Eigen::Vector2d c = (p_map - origin_map_) / cell_m_;
  return {static_cast<int>(std::floor(c.x())), static_cast<int>(std::floor(c.y()))};
}

double CorrelativeGrid::value(const Eigen::Vector2d& p_map) const {
  const Eigen::Vector2i c = cell(p_map);
  return bound(0, c.x(), c.y()) / 255.0;
}

void CorrelativeGrid::draw(std::span<const Eigen::Vector2f> points_map, double sigma_m) {
  const int radius = kernel_radius(sigma_m, cell_m_);
  std::vector<uint8_t>& values = pyramid_.front();
  values.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_), 0);
  for (const Eigen::Vector2f& p : points_map) {
    const Eigen::Vector2d p_map = p.cast<double>();
    const Eigen::Vector2i c = cell(p_map);
    for (int y = c.y() - radius; y <= c.y() + radius; ++y)
      for (int x = c.x() - radius; x <= c.x() + radius; ++x) {
        const Eigen::Vector2d center = origin_map_ + cell_m_ * Eigen::Vector2d(x + 0.5, y + 0.5);
        const double q = (center - p_map).squaredNorm() / (2.0 * sigma_m * sigma_m);
        if (q > 4.5) continue;
        uint8_t& value =
            values[static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x)];
        value = std::max(value, static_cast<uint8_t>(std::lround(255.0 * std::exp(-q))));
      }
  }
}

void CorrelativeGrid::build_pyramid(int levels) {
  for (int level = 0; level < levels; ++level)
    pyramid_.push_back(widen(pyramid_.back(), width_, height_, 1 << level));
}

}  // namespace hmt::submap
