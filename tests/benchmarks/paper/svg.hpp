// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hmt/graph/partition.hpp"
#include "hmt/graph/weighted_graph.hpp"

namespace hmt::paper {

/// A drawing that grows element by element, in pixels, y downwards.
class Svg {
 public:
  Svg(double width, double height);

  void line(Eigen::Vector2d from, Eigen::Vector2d to, const std::string& color, double width = 1);
  void polyline(const std::vector<Eigen::Vector2d>& points, const std::string& color,
                double width = 1);
  void circle(Eigen::Vector2d center, double radius, const std::string& color);
  void frame(Eigen::Vector2d corner, Eigen::Vector2d size, const std::string& color,
             double width = 1);
  /// `anchor`: start, middle or end.
  void text(Eigen::Vector2d at, const std::string& words, const std::string& anchor = "start",
            double size = 12);
  /// Anything else, as SVG.
  void add(const std::string& element) { body_ += element + "\n"; }
  std::string str() const;

 private:
  double width_;
  double height_;
  std::string body_;
};

/// One decimal, for coordinates in pixels.
std::string px(double value);

/// Color of a group: the golden angle around the wheel, so that neighbors differ.
std::string group_color(int group);

/// Omega as an image of `side_px` in the given order of the nodes, black for 1, at most 120 cells a
/// side (means of the weights below). A red square around each run of equal labels, if any are
/// given.
void draw_matrix(Svg& svg, Eigen::Vector2d corner, double side_px,
                 const graph::WeightedGraph& omega, const std::vector<int>& order,
                 const graph::Labels& labels = {});

/// The nodes by group, in each as they were.
std::vector<int> order_by_group(const graph::Labels& labels);

/// World to drawing for maps: one scale for both axes.
class MapView {
 public:
  /// Fits the box low..high (metres) into `size` pixels at `corner`.
  MapView(Eigen::Vector2d low, Eigen::Vector2d high, Eigen::Vector2d corner, Eigen::Vector2d size);
  Eigen::Vector2d operator()(const Eigen::Vector2d& p_world) const;
  double pixels_per_m() const { return scale_; }

 private:
  Eigen::Vector2d low_;
  Eigen::Vector2d corner_;
  double height_;
  double scale_;
};

/// Points as dots of one pixel, each pixel once; as the path of an SVG.
std::string dots(const MapView& view, const std::vector<Eigen::Vector2d>& points_world);

}  // namespace hmt::paper
