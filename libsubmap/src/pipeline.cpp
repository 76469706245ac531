// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/pipeline.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "continue_run.hpp"
#include "hmt/graph/information_loss.hpp"
#include "hmt/graph/pose_covariance.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/submap/link/condense_links.hpp"
#include "hmt/submap/link/loop_effect.hpp"
#include "hmt/submap/link/robust_solution.hpp"
#include "hmt/submap/link/settle_submaps.hpp"
#include "hmt/submap/local/optimize_submap.hpp"
#include "hmt/submap/map/octree.hpp"
#include "hmt/submap/partition/submap_manager.hpp"
#include "link/loop_patch.hpp"

namespace hmt::submap {
namespace {

// The poses stand once a round moves none by more than this, far below what a sensor resolves:
// overlap and partition would come out the same again.
constexpr double kSettledMove_m = 0.02;
constexpr double kSettledTurn_rad = 0.005;
// ... but for a few stray keyframes, which one constraint more or less lets go to and fro.
constexpr double kStrayShare = 0.01;
constexpr double kStrayMove_m = 0.1;
// Bound on the rounds for a log on which loops are still found late.
constexpr int kMaxRounds = 5;
const std::string kSettled = "settled";
// Deviations of a relative pose within which registration finds the right match from the prediction
// alone.
constexpr double kTied_m = 0.1;
constexpr double kTied_rad = 0.03;

graph::PoseGraph graph_of_all(const Track& track, std::span<const Pose> T_world_keyframe,
                              std::span<const Constraint> constraints) {
  std::vector<int> all(track.keyframes.size());
  std::iota(all.begin(), all.end(), 0);
  graph::PoseGraph graph = keyframe_graph(track.space, all, T_world_keyframe, constraints);
  if (!graph.poses.empty()) graph.fixed = {0};
  return graph;
}

std::vector<Pose> track_poses(const Track& track) {
  std::vector<Pose> T_track_robot;
  for (const Keyframe& keyframe : track.keyframes) T_track_robot.push_back(keyframe.T_track_robot);
  return T_track_robot;
}

void read_and_track(MapFile& file, const std::string& stage, const std::filesystem::path& log,
                    const Options& options, const Run& run) {
  const auto reader = open_log(log, options.log);
  StageWriter writer = file.begin(stage);
  const Track track = track_log(
      *reader, options.track, [&writer](const Observation& o) { writer.add(o); }, run);
  writer.put_track(track);
  writer.put_constraints(track.odometry);
  writer.put_loops({});
  writer.put_estimate(track_poses(track));
  writer.commit();
}

std::vector<Constraint> of_kind(std::span<const Constraint> constraints, ConstraintKind kind) {
  std::vector<Constraint> result;
  std::copy_if(constraints.begin(), constraints.end(), std::back_inserter(result),
               [kind](const Constraint& c) { return c.kind == kind; });
  return result;
}

/// Overlap of the keyframes at the present poses, and the registrations that it suggests. Those of
/// earlier rounds stay: where they ended does not depend on the poses they were started from.
void find_overlap(MapFile& file, const Track& track, const std::string& stage,
                  const Options& options, const Run& run) {
  const std::vector<Pose> T_world_keyframe = file.load_estimate();
  std::vector<Constraint> constraints = file.load_constraints();
  const graph::PoseCovariance covariance(graph_of_all(track, T_world_keyframe, constraints));
  // Overlap asks for the pairs of one keyframe after the other.
  const PairCovariance of_pair = [&covariance](int a, int b) {
    return covariance.relative_by_column(a, b);
  };
  const graph::WeightedGraph overlap =
      overlap_graph(track.keyframes, T_world_keyframe, of_pair, file, options.overlap, run);
  const auto registered = of_kind(constraints, ConstraintKind::registration);
  const std::vector<Constraint> found =
      register_overlapping(track.space, track.keyframes, T_world_keyframe, overlap, registered,
                           of_pair, file, options.local, run);
  constraints.insert(constraints.end(), found.begin(), found.end());
  StageWriter writer = file.begin(stage);
  writer.put_overlap(overlap.arcs());
  writer.put_constraints(solve_robustly(track.space, T_world_keyframe, constraints, run).kept);
  writer.commit();
}

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

std::vector<Matrix6d> submap_covariances(const Track& track, std::span<const Pose> T_world_submap,
                                         std::span<const Link> links) {
  const graph::PoseCovariance covariance(submap_graph(track.space, T_world_submap, links));
  std::vector<Matrix6d> covariances;
  for (size_t k = 0; k < T_world_submap.size(); ++k)
    covariances.push_back(covariance.marginal(static_cast<int>(k)).value_or(Matrix6d::Zero()));
  return covariances;
}

/// Submap of each keyframe: of the whole at once, or as the robot would on its way.
graph::Labels partition_all(const Track& track, const graph::WeightedGraph& overlap,
                            std::span<const Constraint> constraints, const std::string& stage,
                            const SubmapPartitionOptions& options, const Run& run) {
  if (!options.sequential)
    return partition_keyframes(track.space, overlap, constraints, options, run.threads);
  return partition_in_sequence(
      track.space, overlap, constraints, options, [&](int keyframe, const AreaEvent& event) {
        const bool entered = event.kind == AreaEvent::Kind::entered;
        run.log_detail(stage + ": keyframe " + std::to_string(keyframe) +
                       (entered ? ": entered area " : ": closed area ") +
                       std::to_string(event.area) + " of " +
                       std::to_string(event.keyframes.size()) + " keyframes");
      });
}

/// Cuts the keyframes into submaps, optimizes each on its own, links them and places them in the
/// world.
void make_submaps(MapFile& file, const Track& track, const std::string& stage,
                  const Options& options, const Run& run) {
  const std::vector<Pose> T_world_keyframe = file.load_estimate();
  const std::vector<Constraint> constraints = file.load_constraints();
  const graph::WeightedGraph overlap(static_cast<int>(track.keyframes.size()), file.load_overlap());
  const graph::Labels partition =
      partition_all(track, overlap, constraints, stage, options.partition, run);
  const std::vector<Submap> submaps = optimize_submaps(
      make_submap_jobs(track.space, partition, T_world_keyframe, constraints), run);
  std::vector<Link> links =
      condense_links(track.space, submaps, partition, constraints, overlap, run);
  MapSolution solution = place_submaps(track, submaps, links, T_world_keyframe, run);
  solution.covariance_world_submap = submap_covariances(track, solution.T_world_submap, links);
  const auto loss =
      graph::information_loss(graph_of_all(track, T_world_keyframe, constraints), partition);
  solution.information_loss = loss.total;
  for (Link& link : links) link.information_loss = loss.between.at({link.a, link.b});
  StageWriter writer = file.begin(stage);
  writer.put_partition(partition);
  for (const Submap& submap : submaps) writer.put_submap(submap);
  writer.put_links(links);
  writer.put_solution(solution);
  writer.commit();
}

std::vector<Pose> keyframe_poses(const HybridMap& map) {
  std::vector<Pose> T_world_keyframe;
  for (const Keyframe& keyframe : map.track.keyframes)
    T_world_keyframe.push_back(world_pose(map, keyframe.id));
  return T_world_keyframe;
}

/// Differences between two sets of poses of the keyframes.
struct Move {
  double metres = 0;  ///< the largest
  double radians = 0;
  int unsettled = 0;  ///< keyframes that moved by more than overlap could ignore
  int keyframes = 0;

  bool is_settled() const { return metres <= kStrayMove_m && unsettled <= kStrayShare * keyframes; }
};

Move move_between(std::span<const Pose> before, std::span<const Pose> after) {
  Move move;
  move.keyframes = static_cast<int>(before.size());
  for (size_t k = 0; k < before.size(); ++k) {
    const Vector6d d = graph::boxminus(after[k], before[k]);
    const double metres = d.head<3>().norm();
    const double radians = d.tail<3>().norm();
    move.metres = std::max(move.metres, metres);
    move.radians = std::max(move.radians, radians);
    if (metres > kSettledMove_m || radians > kSettledTurn_rad) ++move.unsettled;
  }
  return move;
}

/// The same submaps and links with the keyframes at the given poses.
void move_submaps(HybridMap& map, std::span<const Pose> T_world_keyframe) {
  for (Submap& submap : map.submaps) {
    const Pose& T_world_submap = T_world_keyframe[static_cast<size_t>(submap.keyframes.front())];
    map.T_world_submap[static_cast<size_t>(submap.id)] = T_world_submap;
    for (size_t k = 0; k < submap.keyframes.size(); ++k)
      submap.T_submap_keyframe[k] = graph::relative_pose(
          T_world_submap, T_world_keyframe[static_cast<size_t>(submap.keyframes[k])]);
  }
}

/// What the user rejected is not accepted again.
void reject_again(std::vector<LoopCandidate>& candidates, std::span<const LoopCandidate> decided,
                  std::span<const Pose> T_world_keyframe) {
  const std::vector<double> path_m = path_lengths(T_world_keyframe);
  for (LoopCandidate& candidate : candidates)
    for (const LoopCandidate& rejected : decided) {
      if (rejected.verdict != LoopVerdict::rejected || candidate.verdict != LoopVerdict::accepted ||
          !tells_the_same(rejected, candidate, T_world_keyframe, path_m))
        continue;
      candidate.verdict = LoopVerdict::rejected;
      candidate.reason = "tells the same as a candidate that the user rejected";
    }
}

std::vector<LoopCandidate> find_loops(const HybridMap& map, std::span<const Pose> T_world_keyframe,
                                      const MapFile& file, const Run& run) {
  graph::PoseGraph graph = graph_of_all(map.track, T_world_keyframe, map.constraints);
  const graph::PoseCovariance covariance(graph);
  LoopProblem problem;
  problem.space = map.track.space;
  problem.keyframes = map.track.keyframes;
  problem.T_world_keyframe = T_world_keyframe;
  problem.submap = map.submap_of_keyframe;
  problem.covariance = [&covariance](int a, int b) { return covariance.relative(a, b); };
  // What is known this well the next round's overlap registers without a search.
  problem.already_tied = [&problem](int a, int b) {
    if (std::abs(a - b) <= kVisitGap) return true;
    const auto known = problem.covariance(a, b);
    return known && known->topLeftCorner<3, 3>().trace() < kTied_m * kTied_m &&
           known->bottomRightCorner<3, 3>().trace() < kTied_rad * kTied_rad;
  };
  problem.observations = &file;
  std::vector<LoopCandidate> candidates = search_loops(problem, run);
  reject_again(candidates, map.loops, T_world_keyframe);
  return consistent_loops(std::move(candidates), graph);
}

std::vector<Constraint> with_loops(std::vector<Constraint> constraints,
                                   std::span<const LoopCandidate> candidates) {
  for (const LoopCandidate& c : candidates)
    if (is_closure(c.verdict)) constraints.push_back(as_constraint(c));
  return constraints;
}

void mark_outliers(std::vector<LoopCandidate>& candidates, std::span<const Constraint> outliers) {
  for (LoopCandidate& candidate : candidates)
    for (const Constraint& c : outliers)
      if (c.kind == ConstraintKind::loop && c.a == candidate.a && c.b == candidate.b) {
        candidate.verdict = LoopVerdict::outlier;
        candidate.reason = "contradicts the other constraints in the robust optimization";
      }
}

/// New loop closures change what overlaps: the next round starts from the poses that they give.
void take_loops(MapFile& file, const HybridMap& map, std::vector<LoopCandidate> candidates,
                const std::string& stage, const Run& run) {
  const RobustSolution solution = solve_robustly(map.track.space, keyframe_poses(map),
                                                 with_loops(map.constraints, candidates), run);
  mark_outliers(candidates, solution.outliers);
  candidates = join_candidates(map.loops, std::move(candidates));
  StageWriter writer = file.begin(stage);
  writer.put_loops(candidates);
  writer.put_estimate(solution.T_world_keyframe);
  writer.put_constraints(solution.kept);
  writer.commit();
}

graph::PoseOptimizerResult optimize_all(const HybridMap& map, std::span<const Pose> start,
                                        const Run& run) {
  graph::PoseOptimizerOptions options;
  options.threads = run.threads;
  return graph::optimize(graph_of_all(map.track, start, map.constraints), options);
}

/// The map's last poses: all submaps settled against each other, then all keyframes refined
/// together, so that the division into submaps costs no accuracy. `flat`: the same optimum reached
/// without submaps.
graph::PoseOptimizerResult refine_settled(const HybridMap& map,
                                          const graph::PoseOptimizerReport& flat,
                                          DivisionCost& division, const Run& run) {
  const graph::PoseOptimizerResult refined = optimize_all(
      map, settle_submaps(map.track.space, map.submaps, map.T_world_submap, map.constraints), run);
  division = {refined.report.chi2_initial, refined.report.chi2, flat.chi2};
  return refined;
}

/// Refines the poses of all keyframes together and ends the rounds if they stand.
void refine(MapFile& file, HybridMap map, std::vector<LoopCandidate> candidates,
            const std::string& stage, bool last_round, const Run& run) {
  const std::vector<Pose> before = file.load_estimate();
  graph::PoseOptimizerResult result = optimize_all(map, before, run);
  const Move move = move_between(before, result.poses);
  run.log_info(stage + ": keyframes moved by up to " + std::to_string(move.metres) + " m, " +
               std::to_string(move.radians) + " rad; " + std::to_string(move.unsettled) + " of " +
               std::to_string(move.keyframes) + " by more than 2 cm or 0.3 deg");
  const bool settled = last_round || move.is_settled();
  MapSolution solution = file.load_solution();
  candidates = join_candidates(map.loops, std::move(candidates));
  if (settled) {
    result = refine_settled(map, result.report, solution.division, run);
    rate_effects(candidates, graph_of_all(map.track, result.poses, map.constraints),
                 map.constraints, run.threads);
  }
  move_submaps(map, result.poses);
  solution.T_world_submap = map.T_world_submap;
  StageWriter writer = file.begin(settled ? kSettled : stage);
  writer.put_loops(candidates);
  writer.put_estimate(result.poses);
  for (const Submap& submap : map.submaps) writer.put_submap(submap);
  writer.put_solution(solution);
  writer.commit();
}

void close_loops(MapFile& file, const std::string& stage, bool last_round, const Run& run) {
  const HybridMap map = file.load_map();
  std::vector<LoopCandidate> candidates;
  // A loop that is found in the last round could not be made part of the submaps any more.
  if (!last_round) candidates = find_loops(map, keyframe_poses(map), file, run);
  const bool found = std::any_of(candidates.begin(), candidates.end(),
                                 [](const LoopCandidate& c) { return is_closure(c.verdict); });
  if (found) return take_loops(file, map, std::move(candidates), stage, run);
  refine(file, map, std::move(candidates), stage, last_round, run);
}

/// The stages of one run: skips what the file already has, times the rest.
class Stages {
 public:
  Stages(const MapFile& file, const Run& run) : file_(file), run_(run) {}

  template <typename Work>
  void operator()(const std::string& stage, Work&& work) {
    if (file_.finished(stage)) return;
    if (run_.stop_requested()) throw Interrupted{};
    const auto start = std::chrono::steady_clock::now();
    work(stage);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    times_.push_back({stage, taken.count()});
  }
  const std::vector<StageTime>& times() const { return times_; }

 private:
  const MapFile& file_;
  const Run& run_;
  std::vector<StageTime> times_;
};

void improve(MapFile& file, const Track& track, int round, const Options& options, const Run& run,
             Stages& stages) {
  using Name = const std::string&;
  const std::string name = "round" + std::to_string(round);
  stages(name + ".overlap", [&](Name stage) { find_overlap(file, track, stage, options, run); });
  stages(name + ".submaps", [&](Name stage) { make_submaps(file, track, stage, options, run); });
  stages(name + ".loops", [&](Name stage) { close_loops(file, stage, round == kMaxRounds, run); });
}

/// Builds the OctoMaps of a few submaps at a time and commits each of them on its own.
void build_octrees(MapFile& file, const Options& options, const Run& run) {
  const HybridMap map = file.load_map();
  std::vector<int> missing;
  for (const Submap& submap : map.submaps)
    if (!file.has_octree(submap.id)) missing.push_back(submap.id);
  const OctreeOptions octree{options.octree_resolution_m};
  const auto batch = static_cast<size_t>(2 * run.threads);
  tbb::task_arena arena(run.threads);
  for (size_t begin = 0; begin < missing.size(); begin += batch) {
    if (run.stop_requested()) throw Interrupted{};
    run.report({"octomap", static_cast<double>(begin), static_cast<double>(missing.size())});
    std::vector<std::string> trees(std::min(batch, missing.size() - begin));
    arena.execute([&] {
      tbb::parallel_for(size_t{0}, trees.size(), [&](size_t k) {
        const Submap& submap = map.submaps[static_cast<size_t>(missing[begin + k])];
        trees[k] =
            build_octree(observations_in_submap(map.track, submap), file, map.track.space, octree);
      });
    });
    for (size_t k = 0; k < trees.size(); ++k) {
      StageWriter writer = file.begin("octomap" + std::to_string(missing[begin + k]));
      writer.put_octree(missing[begin + k], trees[k]);
      writer.commit();
    }
  }
}

}  // namespace

std::string to_json(const Options& options) {
  nlohmann::ordered_json json;
  json["log"] = {{"scan_topics", options.log.scan_topics},
                 {"odometry_topic", options.log.odometry_topic},
                 {"odometry_file", options.log.odometry_file}};
  json["track"] = {{"keyframe_distance_m", options.track.keyframe_distance_m},
                   {"keyframe_angle_rad", options.track.keyframe_angle_rad}};
  json["overlap"] = {{"max_mahalanobis", options.overlap.max_mahalanobis},
                     {"min_overlap", options.overlap.min_overlap}};
  json["local"] = {{"min_overlap", options.local.min_overlap}};
  json["partition"] = {{"tau", options.partition.tau},
                       {"min_keyframes", options.partition.min_keyframes},
                       {"sequential", options.partition.sequential},
                       {"max_window", options.partition.max_window}};
  json["octree"] = {{"resolution_m", options.octree_resolution_m}};
  return json.dump();
}

Options options_from_json(const std::string& text) {
  Options options;
  try {
    const auto json = nlohmann::json::parse(text);
    const auto get = [&json](const char* stage, const char* name, auto& value) {
      json.at(stage).at(name).get_to(value);
    };
    get("log", "scan_topics", options.log.scan_topics);
    get("log", "odometry_topic", options.log.odometry_topic);
    get("log", "odometry_file", options.log.odometry_file);
    get("track", "keyframe_distance_m", options.track.keyframe_distance_m);
    get("track", "keyframe_angle_rad", options.track.keyframe_angle_rad);
    get("overlap", "max_mahalanobis", options.overlap.max_mahalanobis);
    get("overlap", "min_overlap", options.overlap.min_overlap);
    get("local", "min_overlap", options.local.min_overlap);
    get("partition", "tau", options.partition.tau);
    get("partition", "min_keyframes", options.partition.min_keyframes);
    get("partition", "sequential", options.partition.sequential);
    get("partition", "max_window", options.partition.max_window);
    get("octree", "resolution_m", options.octree_resolution_m);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(std::string("the options of the map cannot be read: ") + error.what());
  }
  return options;
}

std::vector<StageTime> continue_run(MapFile& file, const Options& options, const Run& run) {
  Stages stages(file, run);
  const Track track = file.load_track();
  for (int round = 1; !file.finished(kSettled); ++round)
    improve(file, track, round, options, run, stages);
  stages("octomap", [&](const std::string& stage) {
    build_octrees(file, options, run);
    file.begin(stage).commit();
  });
  return stages.times();
}

BuildResult build_map(const std::filesystem::path& log, const std::filesystem::path& map,
                      const Options& options, MapFile::Existing existing, const Run& run) {
  MapOrigin origin;
  origin.log_path = log.string();
  origin.log_digest = log_digest(log);
  if (!options.log.odometry_file.empty())
    origin.log_digest += log_digest(options.log.odometry_file);
  origin.options_json = to_json(options);
  origin.program_version = HMTMAP_VERSION;
  BuildResult result{MapFile::open_for_run(map, origin, existing), {}};
  MapFile& file = result.file;
  Stages stages(file, run);
  stages("track",
         [&](const std::string& stage) { read_and_track(file, stage, log, options, run); });
  result.times = stages.times();
  const std::vector<StageTime> rest = continue_run(file, options, run);
  result.times.insert(result.times.end(), rest.begin(), rest.end());
  return result;
}

}  // namespace hmt::submap
