// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/occupancy_image.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <mutex>

#include "height_band.hpp"
#include "number_text.hpp"

namespace hmt::submap {
namespace {

/// How many readings had a point in a cell and how many saw through it.
struct CountedCell : DrawnCell {
  uint32_t hits = 0;
  uint32_t misses = 0;
  void hit() { ++hits; }
  void miss() { ++misses; }
};

// Walls that beams graze are missed more often than they are hit; GMapping uses the same share.
constexpr double kOccupiedShare = 0.25;
// Enough for each task to pay; the sums do not depend on it.
constexpr size_t kObservationsInTask = 512;
constexpr double kMaxCells = 1e9;

Occupancy occupancy(const CountedCell& cell) {
  const uint32_t seen = cell.hits + cell.misses;
  if (seen == 0) return Occupancy::unknown;
  return cell.hits >= kOccupiedShare * seen ? Occupancy::occupied : Occupancy::free;
}

/// Cells that were seen; empty if max is below min.
struct Bounds {
  CellIndex min = CellIndex::Constant(std::numeric_limits<int>::max());
  CellIndex max = CellIndex::Constant(std::numeric_limits<int>::min());
};

/// What to draw of readings, and how.
struct Drawing {
  const ObservationStore& store;
  std::optional<HeightBand> band;
  double resolution_m;
  Pose T_corner_frame;

  std::vector<Beam> beams(const Reading& reading, const Pose& T_frame_robot) const {
    const Pose T_corner_robot = T_corner_frame * T_frame_robot;
    return band ? beams_in_band(reading, T_corner_robot, *band, resolution_m)
                : beams_of(reading, T_corner_robot, Space::se2, resolution_m);
  }
};

BlockGrid<CountedCell> count_cells(std::span<const PlacedObservation> observations,
                                   const Drawing& drawing, const Run& run) {
  BlockGrid<CountedCell> total;
  std::mutex mutex;
  bool stopped = false;
  size_t done = 0;
  const size_t tasks = (observations.size() + kObservationsInTask - 1) / kObservationsInTask;
  tbb::task_arena arena(run.threads);
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, tasks, [&](size_t task) {
      {
        const std::lock_guard lock(mutex);
        stopped = stopped || run.stop_requested();
        if (stopped) return;
      }
      BlockGrid<CountedCell> grid;
      uint32_t reading_number = 0;
      const size_t begin = task * kObservationsInTask;
      const size_t count = std::min(kObservationsInTask, observations.size() - begin);
      for (const PlacedObservation& placed : observations.subspan(begin, count)) {
        for (const auto seen = drawing.store.load(placed.observation);
             const Reading& reading : seen->readings)
          cast_beams(drawing.beams(reading, placed.T_frame_robot), ++reading_number, grid);
      }
      const std::lock_guard lock(mutex);
      grid.for_each([&](const CellIndex& index, const CountedCell& cell) {
        if (cell.last_reading == 0) return;
        CountedCell& sum = total.at(index);
        sum.hits += cell.hits;
        sum.misses += cell.misses;
      });
      run.report({"map image", static_cast<double>(++done), static_cast<double>(tasks)});
    });
  });
  if (stopped) throw Interrupted{};
  return total;
}

Bounds bounds_of(const BlockGrid<CountedCell>& grid) {
  Bounds bounds;
  grid.for_each([&](const CellIndex& index, const CountedCell& cell) {
    if (cell.hits + cell.misses == 0) return;
    bounds.min = bounds.min.cwiseMin(index);
    bounds.max = bounds.max.cwiseMax(index);
  });
  if (bounds.min.x() > bounds.max.x()) return {CellIndex::Zero(), CellIndex::Constant(-2)};
  return bounds;
}

}  // namespace

OccupancyImage draw_occupancy(std::span<const PlacedObservation> observations,
                              const ObservationStore& store, const std::optional<HeightBand>& band,
                              double resolution_m, const Run& run) {
  if (!(resolution_m >= 0.005 && resolution_m <= 10))
    throw InputError("map resolution is " + number_text(resolution_m) +
                     " m; it must lie in [0.005, 10]");
  if (band && !(band->min_m < band->max_m))
    throw InputError("height band is " + number_text(band->min_m) + " to " +
                     number_text(band->max_m) + " m; its lower end must be below its upper end");
  // Drawn around the first observation, so that worlds with a far origin fit too.
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();
  if (!observations.empty())
    corner = resolution_m *
             (observations[0].T_frame_robot.translation / resolution_m).array().floor().matrix();
  const Pose T_corner_frame = Pose{-corner, Eigen::Quaterniond::Identity()};
  const auto grid = count_cells(observations, {store, band, resolution_m, T_corner_frame}, run);
  const Bounds bounds = bounds_of(grid);
  OccupancyImage image;
  image.resolution_m = resolution_m;
  image.width = bounds.max.x() - bounds.min.x() + 3;
  image.height = bounds.max.y() - bounds.min.y() + 3;
  image.origin = corner.head<2>() +
                 resolution_m * (bounds.min.head<2>().cast<double>() - Eigen::Vector2d::Ones());
  if (static_cast<double>(image.width) * image.height > kMaxCells)
    throw InputError("the map image would have " + std::to_string(image.width) + " x " +
                     std::to_string(image.height) + " cells; give a larger --resolution");
  const auto width = static_cast<size_t>(image.width);
  image.cells.assign(width * static_cast<size_t>(image.height), Occupancy::unknown);
  grid.for_each([&](const CellIndex& index, const CountedCell& cell) {
    if (cell.hits + cell.misses == 0) return;
    const auto row = static_cast<size_t>(index.y() - bounds.min.y() + 1);
    image.cells[row * width + static_cast<size_t>(index.x() - bounds.min.x() + 1)] =
        occupancy(cell);
  });
  return image;
}

std::string to_pgm(const OccupancyImage& image) {
  std::string pgm =
      "P5\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n255\n";
  for (int row = image.height - 1; row >= 0; --row)
    for (int column = 0; column < image.width; ++column)
      pgm += static_cast<char>(image.at(column, row));
  return pgm;
}

std::string to_map_yaml(const OccupancyImage& image, const std::string& pgm_name) {
  return "image: " + pgm_name + "\nresolution: " + number_text(image.resolution_m) + "\norigin: [" +
         number_text(image.origin.x()) + ", " + number_text(image.origin.y()) +
         ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

}  // namespace hmt::submap
