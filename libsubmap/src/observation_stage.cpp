// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>
#include <vector>

#include "hmt/graph/pose_covariance.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/link/bundle_in_order.hpp"
#include "hmt/submap/link/observation_graph.hpp"
#include "stages.hpp"
#include "whole_map.hpp"

namespace hmt::submap {
namespace {

/// The landmarks and the observations between the keyframes where the map's keyframes put them.
graph::PoseOptimizerResult settle_between_keyframes(graph::PoseGraph graph, const Track& track,
                                                    const graph::PoseOptimizerOptions& options) {
  for (const Keyframe& keyframe : track.keyframes)
    graph.fixed.push_back(static_cast<int>(keyframe.observation));
  std::sort(graph.fixed.begin(), graph.fixed.end());
  graph.fixed.erase(std::unique(graph.fixed.begin(), graph.fixed.end()), graph.fixed.end());
  return graph::optimize(graph, options);
}

}  // namespace

void refine_observations(MapFile& file, const std::string& stage, const Run& run) {
  HybridMap map = file.load_map();
  graph::PoseGraph graph = observation_graph(map.track, keyframe_poses(map), map.sightings, file);
  graph::PoseOptimizerOptions options;
  options.threads = run.threads;
  const graph::PoseOptimizerResult hybrid = settle_between_keyframes(graph, map.track, options);
  graph.poses = hybrid.poses;
  graph.points = hybrid.points;
  const graph::PoseOptimizerResult refined = graph::optimize(graph, options);
  graph::PoseGraph from_odometry = observation_graph(
      map.track, bundle_in_order(map.track, map.sightings, run), map.sightings, file);
  const double flat = graph::optimize(from_odometry, options).report.chi2;
  run.log_info("all observations together: chi2 " + std::to_string(hybrid.report.chi2) +
               " by submaps, " + std::to_string(refined.report.chi2) + " refined, " +
               std::to_string(flat) + " without submaps, " +
               std::to_string(refined.report.degrees_of_freedom) + " degrees of freedom");
  graph.poses = refined.poses;
  graph.points = refined.points;
  std::vector<Pose> T_world_keyframe;
  for (const Keyframe& keyframe : map.track.keyframes)
    T_world_keyframe.push_back(refined.poses[static_cast<size_t>(keyframe.observation)]);
  move_submaps(map, T_world_keyframe);
  MapSolution solution = file.load_solution();
  solution.T_world_submap = map.T_world_submap;
  solution.division = {hybrid.report.chi2, refined.report.chi2, flat};
  const graph::PoseCovariance covariance(graph);
  for (size_t k = 0; k < solution.landmarks.size(); ++k) {
    solution.landmarks[k].position = refined.points[k];
    solution.landmarks[k].covariance =
        covariance.marginal_point(static_cast<int>(k)).value_or(solution.landmarks[k].covariance);
  }
  StageWriter writer = file.begin(stage);
  writer.put_track(hang_on_keyframes(map.track, refined.poses));
  writer.put_estimate(T_world_keyframe);
  for (const Submap& submap : map.submaps) writer.put_submap(submap);
  writer.put_solution(solution);
  writer.commit();
}

}  // namespace hmt::submap
