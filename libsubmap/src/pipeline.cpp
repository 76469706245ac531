// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/pipeline.hpp"

#include <sys/resource.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

#include "continue_run.hpp"
#include "hmt/submap/local/optimize_submap.hpp"
#include "hmt/submap/log/log_reader.hpp"
#include "stages.hpp"
#include "whole_map.hpp"

namespace hmt::submap {
namespace {

// Bound on the rounds for a log on which loops are still found late.
constexpr int kMaxRounds = 5;

/// The largest resident set of this process so far.
size_t peak_memory_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<size_t>(usage.ru_maxrss) << 10;
}

/// The stages of one run: skips what the file already has, times the rest.
class Stages {
 public:
  Stages(const MapFile& file, const std::optional<size_t>& max_memory_bytes, const Run& run)
      : file_(file), max_memory_bytes_(max_memory_bytes), run_(run) {}

  template <typename Work>
  void operator()(const std::string& stage, Work&& work) {
    if (file_.finished(stage)) return;
    if (run_.stop_requested()) throw Interrupted{};
    const auto start = std::chrono::steady_clock::now();
    work(stage);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    times_.push_back({stage, taken.count()});
    watch_memory(stage);
  }
  const std::vector<StageTime>& times() const { return times_; }

 private:
  /// Says once that the bound does not hold.
  void watch_memory(const std::string& stage) {
    const size_t taken = peak_memory_bytes();
    if (warned_ || !max_memory_bytes_ || taken <= *max_memory_bytes_) return;
    warned_ = true;
    run_.log_warning("up to stage " + stage + " " + std::to_string(taken >> 20) +
                     " MB were taken, more than the " + std::to_string(*max_memory_bytes_ >> 20) +
                     " MB that were allowed: of these only caches can be made smaller");
  }

  const MapFile& file_;
  std::optional<size_t> max_memory_bytes_;
  const Run& run_;
  std::vector<StageTime> times_;
  bool warned_ = false;
};

void check(const SectionOptions& options) {
  if (options.keyframes < 1 || options.keyframes > 1000000)
    throw InputError("sections: keyframes is " + std::to_string(options.keyframes) +
                     ", must be in [1, 1000000]");
}

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

/// Gives the caches of observations and surfaces what the bound allows them.
Options with_caches(MapFile& file, Options options) {
  if (options.max_memory_bytes) {
    const size_t caches = *options.max_memory_bytes / 10;
    file.set_cache_bytes(caches / 3 * 2);
    options.local.surface_cache_bytes = caches / 3;
  }
  return options;
}

/// Reads the log into the map; where that fails, a map in which there is nothing is taken away.
std::vector<StageTime> begin_run(MapFile& file, const std::filesystem::path& log,
                                 const Options& options, const Run& run) {
  // The peak of the track is still there when the next stage ends.
  Stages stages(file, std::nullopt, run);
  try {
    stages("track",
           [&](const std::string& stage) { read_and_track(file, stage, log, options, run); });
  } catch (...) {
    if (file.stages().empty()) MapFile::discard(std::move(file));
    throw;
  }
  return stages.times();
}

}  // namespace

std::vector<StageTime> continue_run(MapFile& file, const Options& given, const Run& run) {
  const Options options = with_caches(file, given);
  Stages stages(file, options.max_memory_bytes, run);
  Track track = file.load_track();
  if (!file.load_sightings().empty() && has_scans(track, file))
    stages("landmarks",
           [&](const std::string& stage) { place_by_landmarks(file, track, stage, run); });
  for (int section = 1; file.load_estimate().size() < track.keyframes.size(); ++section)
    stages("section" + std::to_string(section), [&](const std::string& stage) {
      track = add_section(file, track, stage, options, run);
    });
  for (int round = 1; !file.finished(kSettled); ++round)
    improve(file, track, round, options, run, stages);
  if (!file.load_sightings().empty() && !has_scans(track, file))
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
  check(options.sections);
  MapOrigin origin;
  origin.log_path = log.string();
  origin.log_digest = log_digest(log);
  if (!options.log.odometry_file.empty())
    origin.log_digest += log_digest(options.log.odometry_file);
  for (const std::filesystem::path& part : options.log.further_parts) {
    origin.log_path.append(" ").append(part.string());
    origin.log_digest += log_digest(part);
  }
  origin.options_json = to_json(options);
  origin.program_version = HMTMAP_VERSION;
  // A log that cannot be read costs nobody the map that it was to replace.
  if (existing == MapFile::Existing::replace) open_log(log, options.log);
  BuildResult result{MapFile::open_for_run(map, origin, existing), {}};
  result.times = begin_run(result.file, log, options, run);
  const std::vector<StageTime> rest = continue_run(result.file, options, run);
  result.times.insert(result.times.end(), rest.begin(), rest.end());
  return result;
}

}  // namespace hmt::submap
