// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <map>

#include "hmt/submap/export/report.hpp"
#include "number_text.hpp"

namespace hmt::submap {
namespace {

// Wide enough for a page; walls are drawn no finer than this many pixels on the longer side.
constexpr int kSidePixels = 1200;
constexpr double kMarginPixels = 20;

/// World to drawing: y down, one scale for both axes.
struct View {
  Eigen::Vector2d low;
  double pixels_per_m = 1;
  double width = 0;
  double height = 0;

  std::string point(const Eigen::Vector3d& p_world) const {
    std::string text;
    append_number(text, (p_world.x() - low.x()) * pixels_per_m, 1);
    append_number(text, height - (p_world.y() - low.y()) * pixels_per_m, 1);
    return text;
  }
};

View view_of(const HybridMap& map, const std::vector<Pose>& T_world_keyframe,
             const OccupancyImage* walls) {
  Eigen::Vector2d low = T_world_keyframe.at(0).translation.head<2>();
  Eigen::Vector2d high = low;
  for (const Pose& pose : T_world_keyframe) {
    low = low.cwiseMin(pose.translation.head<2>());
    high = high.cwiseMax(pose.translation.head<2>());
  }
  for (const PlacedLandmark& l : map.landmarks) {
    low = low.cwiseMin(l.position.head<2>());
    high = high.cwiseMax(l.position.head<2>());
  }
  if (walls) {
    low = low.cwiseMin(walls->origin);
    high = high.cwiseMax(walls->origin +
                         walls->resolution_m * Eigen::Vector2d(walls->width, walls->height));
  }
  View view;
  view.pixels_per_m = (kSidePixels - 2 * kMarginPixels) / std::max(1.0, (high - low).maxCoeff());
  view.low = low - Eigen::Vector2d::Constant(kMarginPixels / view.pixels_per_m);
  view.width = (high - low).x() * view.pixels_per_m + 2 * kMarginPixels;
  view.height = (high - low).y() * view.pixels_per_m + 2 * kMarginPixels;
  return view;
}

/// True if a cell of the block of `side` cells at that place is occupied.
bool any_occupied(const OccupancyImage& walls, int column, int row, int side) {
  for (int y = row; y < std::min(row + side, walls.height); ++y)
    for (int x = column; x < std::min(column + side, walls.width); ++x)
      if (walls.at(x, y) == Occupancy::occupied) return true;
  return false;
}

/// Occupied cells as one path of horizontal bars.
std::string wall_path(const OccupancyImage& walls, const View& view) {
  const int side = std::max(1, std::max(walls.width, walls.height) / kSidePixels);
  const double cell_m = side * walls.resolution_m;
  const std::string thickness = fixed_text(cell_m * view.pixels_per_m, 1);
  std::string path;
  for (int row = 0; row < walls.height; row += side)
    for (int column = 0; column < walls.width; column += side) {
      const int start = column;
      while (column < walls.width && any_occupied(walls, column, row, side)) column += side;
      if (column == start) continue;
      const Eigen::Vector2d at =
          walls.origin + walls.resolution_m * Eigen::Vector2d(start, row + side / 2.0);
      const double length = (column - start) * walls.resolution_m * view.pixels_per_m;
      path.append("M").append(view.point({at.x(), at.y(), 0})).append("h");
      path.append(fixed_text(length, 1));
    }
  return "<path d=\"" + path + "\" stroke=\"#444\" stroke-width=\"" + thickness +
         "\" fill=\"none\"/>\n";
}

/// Colors that differ from one submap to the next: the golden angle around the wheel.
std::string color(int submap) {
  return "hsl(" + fixed_text(std::fmod(submap * 137.508, 360.0), 0) + ",75%,45%)";
}

/// One polyline for each stretch of keyframes in one submap; stretches meet.
std::string trajectory_lines(const HybridMap& map, const std::vector<Pose>& T_world_keyframe,
                             const View& view) {
  std::string svg;
  for (size_t k = 0; k < T_world_keyframe.size();) {
    const int submap = map.submap_of_keyframe[k];
    svg += "<polyline fill=\"none\" stroke-width=\"2.5\" stroke=\"" + color(submap) +
           "\" points=\"" + view.point(T_world_keyframe[k].translation);
    for (++k; k < T_world_keyframe.size(); ++k) {
      svg += view.point(T_world_keyframe[k].translation);
      if (map.submap_of_keyframe[k] != submap) break;
    }
    svg += "\"/>\n";
  }
  return svg;
}

/// Every landmark in the color of the submap that saw it most often (the smaller id on a tie).
std::string landmark_marks(const HybridMap& map, const View& view) {
  std::map<int, std::map<int, int>> sightings;  // landmark, submap: number
  for (const Sighting& s : map.sightings)
    ++sightings[s.landmark][map.submap_of_keyframe[static_cast<size_t>(s.keyframe)]];
  std::string svg;
  for (const PlacedLandmark& l : map.landmarks) {
    const std::map<int, int>& by_submap = sightings[l.landmark];
    const auto most = std::max_element(by_submap.begin(), by_submap.end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
    if (most == by_submap.end()) continue;
    svg += "<g transform=\"translate(" + view.point(l.position) +
           ")\"><path d=\"M0-7L6 4H-6Z\" stroke=\"#222\" fill=\"" + color(most->first) +
           "\"/></g>\n";
  }
  return svg;
}

/// Middle of a submap's keyframes in the world: its frame lies at one end.
Eigen::Vector3d middle(const HybridMap& map, const Submap& submap) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Pose& pose : submap.T_submap_keyframe) sum += pose.translation;
  return map.T_world_submap[static_cast<size_t>(submap.id)] *
         Eigen::Vector3d(sum / static_cast<double>(submap.T_submap_keyframe.size()));
}

std::string graph_lines(const HybridMap& map, const View& view) {
  std::string svg;
  for (const Link& link : map.links) {
    const std::string a = view.point(middle(map, map.submaps[static_cast<size_t>(link.a)]));
    const std::string b = view.point(middle(map, map.submaps[static_cast<size_t>(link.b)]));
    svg += "<path d=\"M" + a + " L" + b +
           "\" stroke=\"#000\" stroke-opacity=\"0.4\" "
           "stroke-dasharray=\"4 3\"/>\n";
  }
  for (const Submap& submap : map.submaps) {
    const std::string at = view.point(middle(map, submap));
    svg += "<g transform=\"translate(" + at + ")\"><circle r=\"10\" fill=\"" + color(submap.id) +
           "\"/><text text-anchor=\"middle\" dy=\"4\" fill=\"#fff\" font-size=\"11\">" +
           std::to_string(submap.id) + "</text></g>\n";
  }
  return svg;
}

}  // namespace

std::string map_svg(const HybridMap& map, const OccupancyImage* walls) {
  std::vector<Pose> T_world_keyframe;
  for (const Keyframe& keyframe : map.track.keyframes)
    T_world_keyframe.push_back(world_pose(map, keyframe.id));
  const View view = view_of(map, T_world_keyframe, walls);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
                    fixed_text(view.width, 0) + " " + fixed_text(view.height, 0) +
                    "\" font-family=\"sans-serif\">\n";
  if (walls) svg += wall_path(*walls, view);
  return svg + trajectory_lines(map, T_world_keyframe, view) + landmark_marks(map, view) +
         graph_lines(map, view) + "</svg>\n";
}

}  // namespace hmt::submap
