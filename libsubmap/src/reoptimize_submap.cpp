// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/reoptimize_submap.hpp"

#include <algorithm>
#include <string>

#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/local/optimize_submap.hpp"
#include "hmt/submap/map/octree.hpp"
#include "hmt/submap/pipeline.hpp"

namespace hmt::submap {
namespace {

SubmapJob job_of(const HybridMap& map, const Submap& submap) {
  SubmapJob job{map.track.space,
                submap.id,
                submap.keyframes,
                submap.T_submap_keyframe,
                submap.constraints,
                {},
                {}};
  for (const int c : submap.constraints)
    job.constraints.push_back(map.constraints.at(static_cast<size_t>(c)));
  for (const Sighting& sighting : map.sightings)
    if (map.submap_of_keyframe.at(static_cast<size_t>(sighting.keyframe)) == submap.id)
      job.sightings.push_back(sighting);
  return job;
}

double chi2_of(const SubmapJob& job) {
  const graph::PoseGraph graph =
      keyframe_graph(job.space, job.keyframes, job.T_any_keyframe, job.constraints, job.sightings);
  return graph::optimize(graph, {}).report.chi2_initial;
}

SubmapReoptimization compare(const SubmapJob& job, const Submap& after) {
  SubmapReoptimization result;
  result.chi2_before = chi2_of(job);
  result.chi2 = after.chi2;
  for (size_t k = 0; k < after.T_submap_keyframe.size(); ++k) {
    const Vector6d move = graph::boxminus(after.T_submap_keyframe[k], job.T_any_keyframe[k]);
    result.largest_move_m = std::max(result.largest_move_m, move.head<3>().norm());
    result.largest_turn_rad = std::max(result.largest_turn_rad, move.tail<3>().norm());
  }
  return result;
}

/// Stages are named once: "submap12.1", "submap12.2", ...
std::string next_stage(const MapFile& file, int submap) {
  const std::string name = "submap" + std::to_string(submap) + ".";
  int number = 1;
  while (file.finished(name + std::to_string(number))) ++number;
  return name + std::to_string(number);
}

}  // namespace

SubmapReoptimization reoptimize_submap(const std::filesystem::path& path, int id, const Run& run) {
  MapFile file = MapFile::open_for_change(path);
  if (!file.complete())
    throw InputError(path.string() + ": the map is not finished; run hmtmap map again first");
  const HybridMap map = file.load_map();
  if (id < 0 || static_cast<size_t>(id) >= map.submaps.size())
    throw InputError(path.string() + ": there is no submap " + std::to_string(id) + "; it has " +
                     std::to_string(map.submaps.size()) + ", the first is 0");
  const SubmapJob job = job_of(map, map.submaps[static_cast<size_t>(id)]);
  const Submap optimized = optimize_submap(job);
  const Options options = options_from_json(file.origin().options_json);
  const std::string tree = build_octree(observations_in_submap(map.track, optimized), file,
                                        map.track.space, octree_options(options, map.track.space));
  if (run.stop_requested()) throw Interrupted{};
  StageWriter writer = file.begin(next_stage(file, id));
  writer.put_submap(optimized);
  writer.put_octree(id, tree);
  writer.commit();
  return compare(job, optimized);
}

}  // namespace hmt::submap
