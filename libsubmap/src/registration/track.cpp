// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/track.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "landmark_sightings.hpp"
#include "landmark_track.hpp"
#include "tracker.hpp"
#include "validate_track_options.hpp"

namespace hmt::submap {

void validate(const TrackOptions& options) {
  const auto check = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high))
      throw InputError(std::string(name) + " is " + std::to_string(value) + ", must be in [" +
                       std::to_string(low) + ", " + std::to_string(high) + "]");
  };
  check("keyframe_distance_m", options.keyframe_distance_m, 0.05, 10);
  check("keyframe_angle_rad", options.keyframe_angle_rad, 0.02, std::numbers::pi);
}

namespace {

// Observations that are read at once, so that their surfaces can be made while those before them
// are tracked: few enough of them and of their points that they take some megabytes.
constexpr size_t kBatch = 32;
constexpr size_t kBatchPoints = 30000;

struct Batch {
  struct Entry {
    Observation observation;
    Surface surface;
  };
  std::vector<Entry> entries;
  int64_t bytes_read = 0;  ///< of the log, up to the last entry
};

/// Empty at the end of the log.
Batch read_batch(LogReader& log) {
  Batch batch;
  size_t points = 0;
  while (batch.entries.size() < kBatch && points < kBatchPoints) {
    std::optional<Observation> observation = log.next();
    if (!observation) break;
    Surface surface = make_surface(*observation);
    points += surface.size();
    batch.entries.push_back({std::move(*observation), std::move(surface)});
  }
  batch.bytes_read = static_cast<int64_t>(log.bytes_read());
  return batch;
}

void track_batch(Tracker& tracker, LandmarkSightings& sightings, Batch& batch,
                 const std::function<void(const Observation&)>& keep, const Run& run) {
  for (Batch::Entry& entry : batch.entries) {
    if (run.stop_requested()) throw Interrupted{};
    tracker.add(entry.observation, std::move(entry.surface));
    if (!entry.observation.landmark_readings.empty())
      sightings.add(entry.observation, tracker.latest(), tracker.covariance_keyframe_robot());
    if (keep) keep(entry.observation);
  }
}

}  // namespace

TrackedLog track_log(LogReader& log, const TrackOptions& options,
                     const std::function<void(const Observation&)>& keep, const Run& run) {
  if (log.has_landmarks_only()) return track_landmarks(log, options, keep, run);
  validate(options);
  Tracker tracker(log.space(), options);
  LandmarkSightings sightings(log.space(), options);
  int64_t count = 0;
  tbb::task_arena arena(run.threads);
  Batch next = read_batch(log);
  while (!next.entries.empty()) {
    Batch batch = std::move(next);
    next = {};
    // What is tracked and what is read and prepared meanwhile have nothing in common.
    const auto task = [&](int k) {
      if (k == 0)
        track_batch(tracker, sightings, batch, keep, run);
      else
        next = read_batch(log);
    };
    arena.execute([&] { tbb::parallel_for(0, 2, task); });
    count += static_cast<int64_t>(batch.entries.size());
    run.report(
        {"track", static_cast<double>(batch.bytes_read), static_cast<double>(log.bytes_total())});
  }
  if (count == 0) throw InputError("the log holds no observation");
  const TrackCounts& counts = tracker.counts();
  run.log_info("registered " + std::to_string(counts.registered) + " of " + std::to_string(count) +
               " observations, " + std::to_string(counts.searched) + " of them after a search; " +
               std::to_string(counts.odometry_only) + " by odometry alone");
  TrackedLog result{tracker.take(), sightings.take(), sightings.names()};
  Track& track = result.track;
  track.log = log.report();
  if (sightings.unnamed() > 0)
    track.log.notes["landmarks without a name left out beside scans"] += sightings.unnamed();
  if (!result.sightings.empty())
    run.log_info(std::to_string(result.sightings.size()) + " sightings of " +
                 std::to_string(result.names.size()) + " landmarks");
  if (counts.odometry_jumps > 0) {
    track.log.notes["odometry jumps, bridged by registration"] += counts.odometry_jumps;
    run.log_warning("odometry jumps " + std::to_string(counts.odometry_jumps) +
                    " times; the steps are taken from registration");
  }
  if (counts.lost > 0) {
    track.log.notes["clouds without odometry that fit nowhere, a guess took their place"] +=
        counts.lost;
    run.log_warning("lost " + std::to_string(counts.lost) +
                    " times: without odometry these clouds fit nowhere on those before; how the "
                    "robot went there is a guess");
  }
  return result;
}

}  // namespace hmt::submap
