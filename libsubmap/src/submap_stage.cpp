// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <map>
#include <span>
#include <utility>

#include "hmt/graph/information_loss.hpp"
#include "hmt/graph/point_information_loss.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/link/condense_links.hpp"
#include "hmt/submap/local/optimize_submap.hpp"
#include "hmt/submap/partition/submap_manager.hpp"
#include "stages.hpp"
#include "whole_map.hpp"

namespace hmt::submap {
namespace {

std::vector<Submap> optimize_submaps(const std::vector<SubmapJob>& jobs, const Run& run) {
  std::vector<Submap> submaps(jobs.size());
  tbb::task_arena arena(run.threads);
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, jobs.size(),
                      [&](size_t k) { submaps[k] = optimize_submap(jobs[k]); });
  });
  return submaps;
}

/// T_world_submap from the graph of submaps and links, the poses before as the start.
MapSolution place_submaps(const Track& track, std::span<const Submap> submaps,
                          std::span<const Link> links, std::span<const Pose> T_world_keyframe,
                          const Run& run) {
  std::vector<Pose> T_world_submap;
  for (const Submap& submap : submaps)
    T_world_submap.push_back(T_world_keyframe[static_cast<size_t>(submap.keyframes.front())]);
  graph::PoseOptimizerOptions options;
  options.threads = run.threads;
  const auto result = graph::optimize(submap_graph(track.space, T_world_submap, links), options);
  MapSolution solution;
  solution.T_world_submap = result.poses;
  solution.chi2_initial = result.report.chi2_initial;
  solution.chi2 = result.report.chi2;
  return solution;
}

/// Submaps that saw each landmark that was seen, in the order of landmarks_seen().
std::vector<std::vector<int>> submaps_of_landmarks(std::span<const Submap> submaps) {
  std::map<int, std::vector<int>> by_landmark;
  for (const Submap& submap : submaps)
    for (const PlacedLandmark& l : submap.landmarks) by_landmark[l.landmark].push_back(submap.id);
  std::vector<std::vector<int>> result;
  for (auto& [landmark, ids] : by_landmark) result.push_back(std::move(ids));
  return result;
}

/// Submap of each keyframe: of the whole at once, or as the robot would on its way.
graph::Labels partition_all(const Track& track, const graph::WeightedGraph& overlap,
                            std::span<const Constraint> constraints,
                            std::span<const Sighting> sightings, const std::string& stage,
                            const SubmapPartitionOptions& options, const Run& run) {
  if (!options.sequential)
    return partition_keyframes(track.space, overlap, constraints, sightings, options, run.threads);
  return partition_in_sequence(
      track.space, overlap, constraints, options, [&](int keyframe, const AreaEvent& event) {
        const bool entered = event.kind == AreaEvent::Kind::entered;
        run.log_detail(stage + ": keyframe " + std::to_string(keyframe) +
                       (entered ? ": entered area " : ": closed area ") +
                       std::to_string(event.area) + " of " +
                       std::to_string(event.keyframes.size()) + " keyframes");
      });
}

}  // namespace

void make_submaps(MapFile& file, const Track& track, const std::string& stage,
                  const Options& options, const Run& run) {
  const std::vector<Pose> T_world_keyframe = file.load_estimate();
  const std::vector<Constraint> constraints = file.load_constraints();
  const std::vector<Sighting> sightings = file.load_sightings();
  const graph::WeightedGraph overlap(static_cast<int>(track.keyframes.size()), file.load_overlap());
  const graph::Labels partition =
      partition_all(track, overlap, constraints, sightings, stage, options.partition, run);
  const std::vector<Submap> submaps = optimize_submaps(
      make_submap_jobs(track.space, partition, T_world_keyframe, constraints, sightings), run);
  std::vector<Link> links =
      condense_links(track.space, submaps, partition, constraints, sightings, overlap, run);
  MapSolution solution = place_submaps(track, submaps, links, T_world_keyframe, run);
  const graph::PoseGraph all = graph_of_all(track, T_world_keyframe, constraints, sightings);
  add_covariances(all, track, submaps, sightings, solution);
  const auto loss = graph::information_loss(all, partition);
  solution.landmark_information_loss =
      graph::point_information_loss(all, submaps_of_landmarks(submaps));
  solution.information_loss = loss.total;
  for (Link& link : links)
    if (const auto between = loss.between.find({link.a, link.b}); between != loss.between.end())
      link.information_loss = between->second;
  StageWriter writer = file.begin(stage);
  writer.put_partition(partition);
  for (const Submap& submap : submaps) writer.put_submap(submap);
  writer.put_links(links);
  writer.put_solution(solution);
  writer.commit();
}

}  // namespace hmt::submap
