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

/// Options of the whole run, one struct a stage.
struct Options {
  LogOptions log;
  TrackOptions track;
  OverlapOptions overlap;
  LocalConstraintOptions local;
  SubmapPartitionOptions partition;
  /// Edge of the smallest cells of the OctoMaps, metres, [0.005, 10]; nothing: see
  /// octree_options().
  std::optional<double> octree_resolution_m;
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
///   read and track -> (overlap -> submaps -> loop closures) until the poses stand -> OctoMaps
/// Every arrow commits its result to the map file. Same map for any number of threads.
/// Throws InputError for a log or a map file that cannot be used, Interrupted if Run::stop asks for
/// it.
BuildResult build_map(const std::filesystem::path& log, const std::filesystem::path& map,
                      const Options& options, MapFile::Existing existing, const Run& run);

}  // namespace hmt::submap
