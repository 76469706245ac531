// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/track.hpp"

#include <numbers>
#include <string>

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

Track track_log(LogReader& log, const TrackOptions& options,
                const std::function<void(const Observation&)>& keep, const Run& run) {
  validate(options);
  Tracker tracker(log.space(), options);
  int64_t count = 0;
  while (const std::optional<Observation> observation = log.next()) {
    if (run.stop_requested()) throw Interrupted{};
    tracker.add(*observation);
    if (keep) keep(*observation);
    if (++count % 100 == 0)
      run.report(
          {"track", static_cast<double>(log.bytes_read()), static_cast<double>(log.bytes_total())});
  }
  if (count == 0) throw InputError("the log holds no observation");
  const TrackCounts& counts = tracker.counts();
  run.log_info("registered " + std::to_string(counts.registered) + " of " + std::to_string(count) +
               " observations, " + std::to_string(counts.searched) + " of them after a search; " +
               std::to_string(counts.odometry_only) + " by odometry alone");
  Track track = tracker.take();
  track.log = log.report();
  if (counts.odometry_jumps > 0) {
    track.log.notes["odometry jumps, bridged by registration"] += counts.odometry_jumps;
    run.log_warning("odometry jumps " + std::to_string(counts.odometry_jumps) +
                    " times; the steps are taken from registration");
  }
  return track;
}

}  // namespace hmt::submap
