// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hmt/submap/map/map_file.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

struct ExportOptions {
  /// Which of export_parts(); empty for all that the map has.
  std::vector<std::string> parts;
  /// Side of the pixels of map.pgm, metres, [0.005, 10]; raising it makes a smaller, coarser image.
  /// Unless given, 0.05 of planar maps, 0.2 of maps in space, whose clouds are sparser.
  std::optional<double> map_resolution_m;
  /// Least and largest height of what map.pgm shows of clouds, metres over the robot's origin;
  /// found from the ground unless given. Of planar maps none.
  std::optional<std::array<double, 2>> height_band_m;
  /// Whether files that are there already are replaced.
  bool overwrite = false;
};

/// Names of what can be exported and the files each one writes:
///   trajectory  trajectory.tum: T_world_robot of every observation, with the log's own stamps
///   partition   partition.csv
///   topology    topology.json, topology.graphml, topology.dot
///   pose_graph  pose_graph.g2o: submaps and links
///   map         map.pgm, map.yaml: occupancy of the ground plane of the world
///   submaps     submaps/NNNN.ot, .bt, .ply, .pcd: OctoMap and cloud of each, in its own frame
///   landmarks   landmarks.csv: where the map has some; it has no image and no OctoMaps then
///   loops       loops.jsonl: every loop-closure candidate
///   report      report.html: all of it at a glance
std::vector<std::string> export_parts();

/// Writes the parts into the folder, which is made if needed, and returns their paths relative to
/// it. Each file appears whole or not at all. Submaps are read one at a time for each thread. Same
/// bytes for any number of threads. Throws InputError for an unknown part, a map that is not
/// finished, a file that is there already (before anything is written; not with `overwrite`), and
/// where writing fails.
std::vector<std::string> export_map(const MapFile& file, const std::filesystem::path& folder,
                                    const ExportOptions& options, const Run& run);

}  // namespace hmt::submap
