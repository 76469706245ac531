// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

namespace hmt::paper {
namespace {

constexpr int kMostCells = 120;
constexpr int kGrays = 8;

/// Means of the weights of blocks of `step` x `step` nodes, in [0, 1].
std::vector<std::vector<double>> block_means(const graph::WeightedGraph& omega,
                                             const std::vector<int>& order, int step) {
  const auto n = static_cast<int>(order.size());
  const auto cells = static_cast<size_t>((n + step - 1) / step);
  std::vector<int> place(order.size());
  for (int i = 0; i < n; ++i) place[static_cast<size_t>(order[static_cast<size_t>(i)])] = i;
  std::vector<std::vector<double>> sum(cells, std::vector<double>(cells, 0));
  for (const graph::Arc& arc : omega.arcs()) {
    const auto a = static_cast<size_t>(place[static_cast<size_t>(arc.a)] / step);
    const auto b = static_cast<size_t>(place[static_cast<size_t>(arc.b)] / step);
    sum[a][b] += arc.weight;
    sum[b][a] += arc.weight;
  }
  for (auto& row : sum)
    for (double& value : row) value /= step * step;
  return sum;
}

}  // namespace

std::string px(double value) {
  return fmt::format("{:.1f}", value);
}

std::string group_color(int group) {
  return fmt::format("hsl({:.0f},75%,45%)", std::fmod(group * 137.508, 360.0));
}

Svg::Svg(double width, double height) : width_(width), height_(height) {}

void Svg::line(Eigen::Vector2d from, Eigen::Vector2d to, const std::string& color, double width) {
  polyline({from, to}, color, width);
}

void Svg::polyline(const std::vector<Eigen::Vector2d>& points, const std::string& color,
                   double width) {
  std::string path;
  for (const Eigen::Vector2d& p : points)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', p.x(), p.y());
  add(fmt::format(R"(<path d="{}" fill="none" stroke="{}" stroke-width="{}"/>)", path, color,
                  px(width)));
}

void Svg::circle(Eigen::Vector2d center, double radius, const std::string& color) {
  add(fmt::format(R"(<circle cx="{}" cy="{}" r="{}" fill="{}"/>)", px(center.x()), px(center.y()),
                  px(radius), color));
}

void Svg::frame(Eigen::Vector2d corner, Eigen::Vector2d size, const std::string& color,
                double width) {
  add(fmt::format(
      R"(<rect x="{}" y="{}" width="{}" height="{}" fill="none" stroke="{}" stroke-width="{}"/>)",
      px(corner.x()), px(corner.y()), px(size.x()), px(size.y()), color, px(width)));
}

void Svg::text(Eigen::Vector2d at, const std::string& words, const std::string& anchor,
               double size) {
  add(fmt::format(R"(<text x="{}" y="{}" text-anchor="{}" font-size="{}">{}</text>)", px(at.x()),
                  px(at.y()), anchor, px(size), words));
}

std::string Svg::str() const {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" "
      "height=\"{1:.0f}\" font-family=\"sans-serif\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#fff\"/>\n{2}</svg>\n",
      width_, height_, body_);
}

void draw_matrix(Svg& svg, Eigen::Vector2d corner, double side_px,
                 const graph::WeightedGraph& omega, const std::vector<int>& order,
                 const graph::Labels& labels) {
  const auto n = static_cast<int>(order.size());
  if (n == 0) return;
  const int step = (n + kMostCells - 1) / kMostCells;
  const auto cells = block_means(omega, order, step);
  const double cell_px = side_px * step / n;
  // One path a gray level: horizontal bars.
  std::vector<std::string> paths(kGrays + 1);
  for (size_t y = 0; y < cells.size(); ++y) {
    const auto level = [&](size_t x) {
      return static_cast<int>(std::lround(cells[y][x] * kGrays));
    };
    for (size_t x = 0; x < cells.size();) {
      const size_t begin = x;
      while (x < cells.size() && level(x) == level(begin)) ++x;
      const auto gray = static_cast<size_t>(std::clamp(level(begin), 0, kGrays));
      if (gray == 0) continue;
      paths[gray] += fmt::format("M{} {}h{}", begin, y, x - begin);
    }
  }
  // In units of a cell, bars at half height.
  svg.add(fmt::format(
      R"svg(<g transform="translate({:.2f} {:.2f}) scale({:.4f})" fill="none" stroke-width="1">)svg",
      corner.x(), corner.y() + cell_px / 2, cell_px));
  for (int gray = 1; gray <= kGrays; ++gray) {
    const int shade = 255 - 255 * gray / kGrays;
    if (!paths[static_cast<size_t>(gray)].empty())
      svg.add(fmt::format(R"svg(<path d="{}" stroke="rgb({},{},{})"/>)svg",
                          paths[static_cast<size_t>(gray)], shade, shade, shade));
  }
  svg.add("</g>");
  svg.frame(corner, {side_px, side_px}, "#000");
  for (int i = 0; !labels.empty() && i < n;) {
    const int begin = i;
    const auto label = [&](int k) {
      return labels[static_cast<size_t>(order[static_cast<size_t>(k)])];
    };
    while (i < n && label(i) == label(begin)) ++i;
    const double at = side_px * begin / n;
    const double size = side_px * (i - begin) / n;
    svg.frame(corner + Eigen::Vector2d(at, at), {size, size}, "#d00");
  }
}

std::vector<int> order_by_group(const graph::Labels& labels) {
  std::vector<int> order(labels.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return labels[static_cast<size_t>(a)] < labels[static_cast<size_t>(b)];
  });
  return order;
}

MapView::MapView(Eigen::Vector2d low, Eigen::Vector2d high, Eigen::Vector2d corner,
                 Eigen::Vector2d size)
    : low_(low), corner_(corner), height_(size.y()) {
  const Eigen::Vector2d extent = (high - low).cwiseMax(1e-6);
  scale_ = std::min(size.x() / extent.x(), size.y() / extent.y());
}

Eigen::Vector2d MapView::operator()(const Eigen::Vector2d& p_world) const {
  const Eigen::Vector2d p = (p_world - low_) * scale_;
  return corner_ + Eigen::Vector2d(p.x(), height_ - p.y());
}

std::string dots(const MapView& view, const std::vector<Eigen::Vector2d>& points_world) {
  std::set<std::pair<int, int>> pixels;  // by row
  for (const Eigen::Vector2d& p : points_world) {
    const Eigen::Vector2d at = view(p);
    pixels.emplace(static_cast<int>(at.y()), static_cast<int>(at.x()));
  }
  std::string path;
  for (auto pixel = pixels.begin(); pixel != pixels.end();) {
    const auto [y, x] = *pixel;
    int end = x;
    while (pixel != pixels.end() && *pixel == std::pair(y, end)) {
      ++pixel;
      ++end;
    }
    path += fmt::format("M{} {}h{}", x, y, end - x);
  }
  return path;
}

}  // namespace hmt::paper
