// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hmt/submap/local/local_constraints.hpp"
#include "hmt/submap/map/map_file.hpp"
#include "hmt/submap/map/octree.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "hmt/submap/partition/submap_partition.hpp"
#include "hmt/submap/registration/track.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// Sections that a log is gone through in. Memory follows them and the places that the robot saw,
/// not the log; smaller ones are re-estimated with what was known more often.
struct SectionOptions {
  /// Keyframes of a section, [1, 1000000]: some rounds through a building, over which the robot
  /// drifts so little that the loop search finds back. The last one may have half as many more.
  int keyframes = 2000;
};

/// Options of the whole run, one struct a stage.
struct Options {
  LogOptions log;
  TrackOptions track;
  OverlapOptions overlap;
  LocalConstraintOptions local;
  SectionOptions sections;
  SubmapPartitionOptions partition;
  /// Edge of the smallest cells of the OctoMaps, metres, [0.005, 10]; nothing: see
  /// octree_options().
  std::optional<double> octree_resolution_m;
  /// Bytes that the run may take. Observations and surfaces that are kept to be used again take up
  /// to a tenth of them, 96 MB where no bound is given; the rest follows the map, and a warning
  /// says where that is more. The same map with any bound, so it is no part of to_json.
  std::optional<size_t> max_memory_bytes;
};

/// Without a resolution, 5 cm for planar logs and 20 cm in space, where beams reach far and meet
/// surfaces decimetres apart.
OctreeOptions octree_options(const Options& options, Space space);

/// All options with their values as a JSON object, one member a stage; equal options give equal
/// text.
std::string to_json(const Options& options);
/// The options of a map from its file. Throws InputError if the text is not what to_json gives.
Options options_from_json(const std::string& text);

/// Seconds that a stage took in this run; stages that an earlier run had finished are not there.
struct StageTime {
  std::string stage;
  double seconds = 0;
};

/// The finished map file and how long its stages took.
struct BuildResult {
  MapFile file;
  std::vector<StageTime> times;
};

/// Makes a hybrid map of a log, or goes on where an earlier run with the same log and options was
/// stopped:
///   read and track -> sections -> (overlap -> submaps -> loop closures) until the
///   poses stand -> OctoMaps
/// Every arrow commits its result to the map file. Same map for any number of threads.
/// Throws InputError for options out of range and for a log or a map file that cannot be used,
/// Interrupted if Run::stop asks for it.
BuildResult build_map(const std::filesystem::path& log, const std::filesystem::path& map,
                      const Options& options, MapFile::Existing existing, const Run& run);

}  // namespace hmt::submap
