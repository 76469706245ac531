// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "block_grid.hpp"
#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// A cell that knows in which reading it was last changed; 0 for never. The base of all cells that
/// cast_beams draws in, which need hit() and miss() besides.
struct DrawnCell {
  uint32_t last_reading = 0;
};

/// A beam that met nothing says that much of free space and no more: dark, shining and glazed
/// surfaces give no echo either. Cartographer uses the same length by default.
constexpr double kMissLength_m = 5.0;
/// OctoMap's keys end here, in cells from the origin.
constexpr double kGridEnd = 32767;

/// Ray traversal [Amanatides 1987]: calls visit for the cells from that of `from` to the last one
/// before that of `to`; both in units of cells.
template <class Visit>
void visit_cells_before(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Visit&& visit) {
  const Eigen::Vector3d direction = to - from;
  CellIndex cell = from.array().floor().matrix().cast<int>();
  const CellIndex last = to.array().floor().matrix().cast<int>();
  // Where along the ray, 0..1, it enters the next cell for each axis, and how long it stays in one.
  Eigen::Vector3d next = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d length = next;
  CellIndex step = CellIndex::Zero();
  for (int k = 0; k < 3; ++k) {
    if (cell[k] == last[k]) continue;
    step[k] = direction[k] > 0 ? 1 : -1;
    next[k] = (cell[k] + (direction[k] > 0 ? 1 : 0) - from[k]) / direction[k];
    length[k] = 1 / std::abs(direction[k]);
  }
  // As many steps as lie between the two cells; rounding may not carry the ray past its end.
  for (int left = (last - cell).cwiseAbs().sum(); left > 0; --left) {
    visit(cell);
    int axis = next.x() < next.y() ? 0 : 1;
    if (next.z() < next[axis]) axis = 2;
    cell[axis] += step[axis];
    next[axis] = cell[axis] == last[axis] ? std::numeric_limits<double>::infinity()
                                          : next[axis] + length[axis];
  }
}

/// One measurement to draw, both ends in cells.
struct Beam {
  Eigen::Vector3d from, to;
  bool hit = false;  ///< whether it ends in a point; otherwise the last cell tells nothing
};

inline bool is_on_grid(const Eigen::Vector3d& cells) {
  return cells.allFinite() && cells.cwiseAbs().maxCoeff() < kGridEnd;
}

/// The beams of a reading that lie on the grid.
inline std::vector<Beam> beams_of(const Reading& reading, const Pose& T_frame_robot, Space space,
                                  double resolution_m) {
  const Pose T_frame_sensor = T_frame_robot * reading.T_robot_sensor;
  const auto to_cells = [&](const Eigen::Vector3d& p_sensor) {
    Eigen::Vector3d p = T_frame_sensor * p_sensor / resolution_m;
    if (space == Space::se2) p.z() = 0;  // rounding could put it into the layer below
    return p;
  };
  std::vector<Beam> beams;
  const Eigen::Vector3d from = to_cells(Eigen::Vector3d::Zero());
  if (!is_on_grid(from)) return beams;
  beams.reserve(reading.points_sensor.size() + reading.misses_sensor.size());
  for (const Eigen::Vector3f& p_sensor : reading.points_sensor) {
    const Eigen::Vector3d p = to_cells(p_sensor.cast<double>());
    if (is_on_grid(p)) beams.push_back({from, p, true});
  }
  const double miss_m = std::min(kMissLength_m, reading.max_range_m);
  for (const Eigen::Vector3f& direction : reading.misses_sensor) {
    const Eigen::Vector3d p = to_cells(miss_m * direction.cast<double>());
    if (is_on_grid(p)) beams.push_back({from, p, false});
  }
  return beams;
}

/// Draws the beams of one reading: the cells of its points are hit, the cells that its beams passed
/// are missed. A cell changes at most once for each reading and a hit wins, as in OctoMap's
/// insertPointCloud. `reading_number` is another one for each reading, from 1.
template <class Cell>
void cast_beams(std::span<const Beam> beams, uint32_t reading_number, BlockGrid<Cell>& grid) {
  for (const Beam& beam : beams) {
    if (!beam.hit) continue;
    Cell& cell = grid.at(beam.to.array().floor().matrix().cast<int>());
    if (cell.last_reading == reading_number) continue;
    cell.last_reading = reading_number;
    cell.hit();
  }
  for (const Beam& beam : beams)
    visit_cells_before(beam.from, beam.to, [&](const CellIndex& index) {
      Cell& cell = grid.at(index);
      if (cell.last_reading == reading_number) return;
      cell.last_reading = reading_number;
      cell.miss();
    });
}

}  // namespace hmt::submap
