// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/submap_cloud.hpp"

#include "../map/block_grid.hpp"
#include "hmt/submap/map/octree.hpp"

namespace hmt::submap {
namespace {

struct MeanCell {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int64_t points = 0;
};

// The range of OctoMap's keys.
constexpr double kGridEnd = 32767;

void add_points(const Reading& reading, const Pose& T_frame_robot, double resolution_m,
                BlockGrid<MeanCell>& grid) {
  const Pose T_frame_sensor = T_frame_robot * reading.T_robot_sensor;
  for (const Eigen::Vector3f& p_sensor : reading.points_sensor) {
    const Eigen::Vector3d p = T_frame_sensor * p_sensor.cast<double>();
    const Eigen::Vector3d in_cells = p / resolution_m;
    if (!p.allFinite() || in_cells.cwiseAbs().maxCoeff() >= kGridEnd) continue;
    MeanCell& cell = grid.at(in_cells.array().floor().matrix().cast<int>());
    cell.sum += p;
    ++cell.points;
  }
}

std::string bytes_of(std::span<const Eigen::Vector3f> points) {
  return {reinterpret_cast<const char*>(points.data()), points.size_bytes()};
}

}  // namespace

std::vector<Eigen::Vector3f> submap_cloud(std::span<const PlacedObservation> observations,
                                          const ObservationStore& store,
                                          std::string_view ot_bytes) {
  BlockGrid<MeanCell> grid;
  const double resolution_m = octree_resolution(ot_bytes);
  for (const PlacedObservation& placed : observations)
    for (const auto seen = store.load(placed.observation); const Reading& reading : seen->readings)
      add_points(reading, placed.T_frame_robot, resolution_m, grid);
  std::vector<Eigen::Vector3d> means;
  grid.for_each([&](const CellIndex&, const MeanCell& cell) {
    if (cell.points > 0) means.emplace_back(cell.sum / static_cast<double>(cell.points));
  });
  const std::vector<bool> occupied = in_occupied_cells(ot_bytes, means);
  std::vector<Eigen::Vector3f> cloud;
  for (size_t k = 0; k < means.size(); ++k)
    if (occupied[k]) cloud.emplace_back(means[k].cast<float>());
  return cloud;
}

std::string to_ply(std::span<const Eigen::Vector3f> points) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points.size()) +
         "\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + bytes_of(points);
}

std::string to_pcd(std::span<const Eigen::Vector3f> points) {
  const std::string n = std::to_string(points.size());
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\n"
         "TYPE F F F\nCOUNT 1 1 1\nWIDTH " +
         n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n" +
         bytes_of(points);
}

}  // namespace hmt::submap
