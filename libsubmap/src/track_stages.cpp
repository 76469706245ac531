// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <iterator>
#include <optional>

#include "hmt/graph/pose_covariance.hpp"
#include "hmt/submap/link/bundle_in_order.hpp"
#include "hmt/submap/link/robust_solution.hpp"
#include "hmt/submap/overlap/keyframe_landmarks.hpp"
#include "hmt/submap/registration/track.hpp"
#include "link/landmark_revisits.hpp"
#include "stages.hpp"
#include "whole_map.hpp"

namespace hmt::submap {
namespace {

std::vector<Pose> track_poses(const Track& track) {
  std::vector<Pose> T_track_robot;
  for (const Keyframe& keyframe : track.keyframes) T_track_robot.push_back(keyframe.T_track_robot);
  return T_track_robot;
}

std::vector<Constraint> of_kind(std::span<const Constraint> constraints, ConstraintKind kind) {
  std::vector<Constraint> result;
  std::copy_if(constraints.begin(), constraints.end(), std::back_inserter(result),
               [kind](const Constraint& c) { return c.kind == kind; });
  return result;
}

}  // namespace

void read_and_track(MapFile& file, const std::string& stage, const std::filesystem::path& log,
                    const Options& options, const Run& run) {
  const auto reader = open_log(log, options.log);
  StageWriter writer = file.begin(stage);
  const auto keep = [&writer](const Observation& o) { writer.add(o); };
  const TrackedLog result = track_log(*reader, options.track, keep, run);
  const Track& track = result.track;
  // Logs with landmarks are taken as a whole; of others sections add all but the first keyframe.
  const bool as_a_whole = reader->has_landmarks_only() || !result.sightings.empty();
  writer.put_track(track);
  writer.put_constraints(as_a_whole ? track.odometry : std::vector<Constraint>{});
  writer.put_sightings(result.sightings);
  writer.put_landmark_names(result.names);
  writer.put_loops({});
  std::vector<Pose> estimate =
      result.sightings.empty() ? track_poses(track) : bundle_in_order(track, result.sightings, run);
  if (!as_a_whole) estimate.resize(1);
  writer.put_estimate(estimate);
  writer.commit();
}

void place_by_landmarks(MapFile& file, const Track& track, const std::string& stage,
                        const Run& run) {
  const std::vector<Sighting> sightings = file.load_sightings();
  const std::vector<Constraint> constraints = file.load_constraints();
  RobustSolution solution =
      solve_robustly(track.space, file.load_estimate(), constraints, sightings, run);
  const LandmarkRevisits revisits =
      check_revisits(track, solution.T_world_keyframe, solution.kept_sightings, file);
  if (revisits.contradicted > 0) {
    run.log_warning(std::to_string(revisits.contradicted) +
                    " visits to landmarks are left out: the scans show another place");
    solution = solve_robustly(track.space, bundle_in_order(track, revisits.kept, run), constraints,
                              revisits.kept, run);
  }
  run.log_info(std::to_string(solution.kept_sightings.size()) + " of " +
               std::to_string(sightings.size()) + " sightings agree");
  StageWriter writer = file.begin(stage);
  writer.put_sightings(solution.kept_sightings);
  writer.put_estimate(solution.T_world_keyframe);
  writer.commit();
}

void find_overlap(MapFile& file, const Track& track, const std::string& stage,
                  const Options& options, const Run& run) {
  const std::vector<Pose> T_world_keyframe = file.load_estimate();
  std::vector<Constraint> constraints = file.load_constraints();
  const std::vector<Sighting> sightings = file.load_sightings();
  const graph::PoseCovariance covariance(
      graph_of_all(track, T_world_keyframe, constraints, sightings));
  // Overlap asks for the pairs of one keyframe after the other.
  const PairCovariance of_pair = [&covariance](int a, int b) {
    return covariance.relative_by_column(a, b);
  };
  const std::optional<KeyframeLandmarks> landmarks =
      sightings.empty() ? std::nullopt
                        : std::optional<KeyframeLandmarks>(std::in_place, track, sightings,
                                                           file.load_landmark_names(), file);
  const ObservationStore& sensed =
      landmarks ? static_cast<const ObservationStore&>(*landmarks) : file;
  const graph::WeightedGraph overlap =
      overlap_graph(track.keyframes, T_world_keyframe, of_pair, sensed, options.overlap, run);
  const auto registered = of_kind(constraints, ConstraintKind::registration);
  const std::vector<Constraint> found =
      register_overlapping(track.space, track.keyframes, T_world_keyframe, overlap, registered,
                           of_pair, file, options.local, run);
  constraints.insert(constraints.end(), found.begin(), found.end());
  StageWriter writer = file.begin(stage);
  writer.put_overlap(overlap.arcs());
  const RobustSolution solution =
      solve_robustly(track.space, T_world_keyframe, constraints, sightings, run);
  writer.put_constraints(solution.kept);
  writer.put_sightings(solution.kept_sightings);
  writer.commit();
}

}  // namespace hmt::submap
