// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

namespace hmt::submap {

using Box = Eigen::AlignedBox2d;

/// Where a robot can go and what it sees. Coordinates are metres in the world frame.
struct FloorPlan {
  std::vector<Box> free;       ///< rooms, corridors and doorways; walls are the edge of their union
  std::vector<Box> furniture;  ///< solid boxes inside
  /// Corners of lap k, which starts where lap k - 1 ended.
  std::function<std::vector<Eigen::Vector2d>(int lap)> path;
};

/// A straight piece of wall.
struct Wall {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
};

/// The edges of the union of the free boxes, and those of the furniture. Quadratic in the boxes.
std::vector<Wall> walls(const FloorPlan& plan);

/// The plan of that name; throws InputError naming the known ones. Furniture depends on the seed.
FloorPlan make_floor_plan(const std::string& name, uint64_t seed);

}  // namespace hmt::submap
