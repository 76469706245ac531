// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/local/optimize_submap.hpp"

#include <algorithm>
#include <string>

#include "hmt/graph/pose_covariance.hpp"
#include "hmt/graph/pose_initialization.hpp"
#include "hmt/graph/pose_optimizer.hpp"

namespace hmt::submap {

namespace {

/// Place of a number in an increasing list; -1 if it is not there.
int place_in(std::span<const int> numbers, int number) {
  const auto at = std::lower_bound(numbers.begin(), numbers.end(), number);
  return at != numbers.end() && *at == number ? static_cast<int>(at - numbers.begin()) : -1;
}

}  // namespace

std::vector<int> landmarks_seen(std::span<const int> keyframes,
                                std::span<const Sighting> sightings) {
  std::vector<int> landmarks;
  for (const Sighting& s : sightings)
    if (place_in(keyframes, s.keyframe) >= 0) landmarks.push_back(s.landmark);
  std::sort(landmarks.begin(), landmarks.end());
  landmarks.erase(std::unique(landmarks.begin(), landmarks.end()), landmarks.end());
  return landmarks;
}

graph::PoseGraph keyframe_graph(Space space, std::span<const int> keyframes,
                                std::span<const Pose> T_frame_keyframe,
                                std::span<const Constraint> constraints,
                                std::span<const Sighting> sightings) {
  graph::PoseGraph graph;
  graph.space = space;
  graph.poses.assign(T_frame_keyframe.begin(), T_frame_keyframe.end());
  for (const Constraint& c : constraints) {
    const int from = place_in(keyframes, c.a);
    const int to = place_in(keyframes, c.b);
    if (from >= 0 && to >= 0) graph.edges.push_back({from, to, c.T_a_b, c.information});
  }
  const std::vector<int> landmarks = landmarks_seen(keyframes, sightings);
  graph.points.resize(landmarks.size(), Eigen::Vector3d::Zero());
  for (const Sighting& s : sightings) {
    const int node = place_in(keyframes, s.keyframe);
    if (node >= 0)
      graph.point_edges.push_back(
          {node, place_in(landmarks, s.landmark), s.p_keyframe, s.information});
  }
  graph.points = graph::place_points(graph, graph.poses);
  return graph;
}

std::vector<SubmapJob> make_submap_jobs(Space space, const graph::Labels& submap_of_keyframe,
                                        std::span<const Pose> T_world_keyframe,
                                        std::span<const Constraint> constraints,
                                        std::span<const Sighting> sightings) {
  const int count =
      submap_of_keyframe.empty()
          ? 0
          : *std::max_element(submap_of_keyframe.begin(), submap_of_keyframe.end()) + 1;
  std::vector<SubmapJob> jobs(static_cast<size_t>(count));
  const auto job_of = [&](int keyframe) -> SubmapJob& {
    return jobs[static_cast<size_t>(submap_of_keyframe[static_cast<size_t>(keyframe)])];
  };
  for (int id = 0; id < count; ++id) {
    jobs[static_cast<size_t>(id)].id = id;
    jobs[static_cast<size_t>(id)].space = space;
  }
  for (size_t k = 0; k < submap_of_keyframe.size(); ++k) {
    job_of(static_cast<int>(k)).keyframes.push_back(static_cast<int>(k));
    job_of(static_cast<int>(k)).T_any_keyframe.push_back(T_world_keyframe[k]);
  }
  for (size_t c = 0; c < constraints.size(); ++c) {
    SubmapJob& job = job_of(constraints[c].a);
    if (&job != &job_of(constraints[c].b)) continue;
    job.constraint_ids.push_back(static_cast<int>(c));
    job.constraints.push_back(constraints[c]);
  }
  for (const Sighting& s : sightings) job_of(s.keyframe).sightings.push_back(s);
  return jobs;
}

Submap optimize_submap(const SubmapJob& job) {
  std::vector<Pose> T_submap_keyframe;
  for (const Pose& T_any_keyframe : job.T_any_keyframe)
    T_submap_keyframe.push_back(relative_pose(job.T_any_keyframe.front(), T_any_keyframe));
  graph::PoseGraph graph =
      keyframe_graph(job.space, job.keyframes, T_submap_keyframe, job.constraints, job.sightings);
  graph.fixed = {0};
  const graph::PoseOptimizerResult result = graph::optimize(graph, {});
  graph.poses = result.poses;
  graph.points = result.points;
  Submap submap;
  submap.id = job.id;
  submap.keyframes = job.keyframes;
  submap.T_submap_keyframe = result.poses;
  submap.constraints = job.constraint_ids;
  submap.chi2 = result.report.chi2;
  submap.degrees_of_freedom = static_cast<int>(result.report.degrees_of_freedom);
  const graph::PoseCovariance covariance(graph);
  for (int node = 0; node < static_cast<int>(job.keyframes.size()); ++node) {
    const auto in_submap = covariance.relative(0, node);
    if (!in_submap)
      throw InputError("submap " + std::to_string(job.id) +
                       ": its constraints do not tie keyframe " +
                       std::to_string(job.keyframes[static_cast<size_t>(node)]) + " to the others");
    submap.covariances.push_back(*in_submap);
  }
  const std::vector<int> landmarks = landmarks_seen(job.keyframes, job.sightings);
  for (size_t k = 0; k < landmarks.size(); ++k)
    submap.landmarks.push_back(
        {landmarks[k], graph.points[k], covariance.relative_point(0, static_cast<int>(k)).value()});
  return submap;
}

}  // namespace hmt::submap
