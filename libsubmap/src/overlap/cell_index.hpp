// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sensed_points.hpp"

namespace hmt::submap {

/// Number of a cell along x, y and z.
using CellCoordinates = std::array<int, 3>;

/// The points of a reading in one coarse cell of the common frame.
struct CellCount {
  uint64_t cell = 0;
  int points = 0;
  float gate = 0;  ///< the largest of theirs
};

/// The cells that a reading has points in, by increasing cell.
std::vector<CellCount> count_cells(const SensedPoints& points);

/// Finds the pairs of readings of one sensor whose sensed regions meet and bounds their matches
/// from above, without looking at pairs of points or at pairs that do not meet: an inverted index
/// from cells to the readings that have points there. Readings are kept as runs of consecutive
/// numbers, since consecutive keyframes see the same cells.
class CellIndex {
 public:
  /// Readings begin..end-1 have points which `matches` points of the reading asked for can match at
  /// most.
  struct Bound {
    int begin = 0;
    int end = 0;
    int matches = 0;
  };

  /// `readings[i]`: the cells of reading i, none where there is no reading. `pose_gate_m2`: d^2
  /// times the largest mean square displacement by the pose at which points still match.
  CellIndex(std::vector<std::vector<CellCount>> readings, double pose_gate_m2);

  int num_points(int reading) const { return num_points_[static_cast<size_t>(reading)]; }
  /// Disjoint, by increasing number; readings that cannot match are left out.
  std::vector<Bound> bounds(int reading) const;

 private:
  struct Run {
    int begin = 0;
    int end = 0;
  };
  struct Cell {
    uint64_t key = 0;
    float gate = 0;           ///< the largest of the points in it
    std::vector<Run> inside;  ///< readings with points in it
    std::vector<Run> near;    ///< readings with points that a point in it can match
  };

  void collect_cells();
  void find_near(double pose_gate_m2);
  void link_column(Cell& cell, const CellCoordinates& first, const CellCoordinates& last,
                   double pose_gate_m2);

  std::vector<std::vector<CellCount>> readings_;
  std::vector<int> num_points_;
  std::vector<Cell> cells_;  ///< by increasing key
};

}  // namespace hmt::submap
