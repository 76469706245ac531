// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/pipeline.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "continue_run.hpp"
#include "hmt/submap/local/optimize_submap.hpp"
#include "stages.hpp"

namespace hmt::submap {
namespace {

// Bound on the rounds for a log on which loops are still found late.
constexpr int kMaxRounds = 5;

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
  const OctreeOptions octree = octree_options(options, map.track.space);
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

std::vector<StageTime> continue_run(MapFile& file, const Options& options, const Run& run) {
  Stages stages(file, run);
  const Track track = file.load_track();
  for (int round = 1; !file.finished(kSettled); ++round)
    improve(file, track, round, options, run, stages);
  if (!file.load_sightings().empty())
    stages("observations",
           [&](const std::string& stage) { refine_observations(file, stage, run); });
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
