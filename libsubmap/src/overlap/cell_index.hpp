// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "match_bounds.hpp"
#include "sensed_points.hpp"

namespace hmt::submap {

/// Number of a cell along x, y and z.
using CellCoordinates = std::array<int, 3>;

/// One number for a cell, and back; cells farther out than 2^20 count as those at the border.
uint64_t cell_key(const CellCoordinates& cell);
CellCoordinates cell_coordinates(uint64_t key);

/// The points of a reading in one coarse cell of the common frame.
struct CellCount {
  uint64_t cell = 0;
  int points = 0;
  float gate = 0;  ///< the largest of theirs
};

/// The cells of the given side that points lie in, by increasing cell.
std::vector<CellCount> count_cells(std::span<const SensedPoint> points, float cell_m);

/// Bounds from above how many points of readings of one sensor can match, without looking at pairs
/// of points or at pairs of readings that do not meet: an inverted index from cells to the readings
/// that have points there.
class CellIndex {
 public:
  CellIndex() = default;
  /// `readings[i]`: the cells of reading i, none where there is no reading. `cell_m`: their side.
  /// `pose_gate_m2`: points of gates g and h match up to a square distance of g + h + pose_gate_m2.
  CellIndex(std::vector<std::vector<CellCount>> readings, float cell_m, double pose_gate_m2);

  /// Adds the points of the reading that can match a point of the others.
  void add_matches(int reading, BoundSum& sum) const;

 private:
  struct Cell {
    uint64_t key = 0;
    float gate = 0;                  ///< the largest of the points in it
    std::vector<ReadingRun> inside;  ///< readings with points in it
    std::vector<ReadingRun> near;    ///< readings with points that a point in it can match
  };

  void collect_cells();
  void find_near(double pose_gate_m2);
  void link_column(Cell& cell, const CellCoordinates& first, const CellCoordinates& last,
                   double pose_gate_m2);

  std::vector<std::vector<CellCount>> readings_;
  float cell_m_ = 1;
  std::vector<Cell> cells_;  ///< by increasing key
};

}  // namespace hmt::submap
