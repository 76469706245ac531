// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hmt/submap/map/placed_observation.hpp"
#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// What is known of a cell, with the gray value that map_server gives it.
enum class Occupancy : uint8_t { occupied = 0, unknown = 205, free = 254 };

/// Occupancy of the plane z = 0 of a frame. Row 0 is the lowest y, column 0 the lowest x.
struct OccupancyImage {
  double resolution_m = 0.05;
  /// Lower left corner of the cell in row 0 and column 0.
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  int width = 0;
  int height = 0;
  std::vector<Occupancy> cells;  ///< row by row

  Occupancy at(int column, int row) const {
    return cells[static_cast<size_t>(row) * static_cast<size_t>(width) +
                 static_cast<size_t>(column)];
  }
};

/// Heights over the origin of the robot where it stood, along z, metres; min < max.
struct HeightBand {
  double min_m = 0;
  double max_m = 0;
  /// What counts as level: metres that the plane through the robot's origin rises for a metre along
  /// x and y of the frame. Frames of lidars that were mounted or switched on aslant are tilted.
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();

  bool operator==(const HeightBand&) const = default;
};

/// What a robot or a person could bump into: from 0.3 m to 2 m over the ground. The ground is the
/// plane that fits the points within 5 m of the robot, of some 100 observations together, around
/// the median height of the lowest twentieth of them. It is level where they show no such plane,
/// and z = 0 where there are none.
HeightBand find_height_band(std::span<const PlacedObservation> observations,
                            const ObservationStore& store);

/// Draws planar observations, or what clouds show within the band: a cell is occupied if at least a
/// quarter of the readings that said something of it had a point in it, free if there were fewer,
/// unknown if there were none. With a border of one unknown cell; without observations one unknown
/// cell. Same result for any number of threads. Throws InputError if the resolution is not in
/// [0.005, 10] m, the band is empty, or the image would have more than 10^9 cells.
OccupancyImage draw_occupancy(std::span<const PlacedObservation> observations,
                              const ObservationStore& store, const std::optional<HeightBand>& band,
                              double resolution_m, const Run& run);

/// Binary PGM as map_server and nav2 read it: the first row is the highest y.
std::string to_pgm(const OccupancyImage& image);
/// The YAML file beside it.
std::string to_map_yaml(const OccupancyImage& image, const std::string& pgm_name);

}  // namespace hmt::submap
