// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "hmt/submap/log/log_reader.hpp"
#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/registration/constraint.hpp"
#include "hmt/submap/registration/sighting.hpp"
#include "hmt/submap/run.hpp"

namespace hmt::submap {

/// An observation that becomes a node of the overlap graph.
struct Keyframe {
  int id = 0;               ///< 0.., in the order of the log
  int64_t observation = 0;  ///< its index in the log
  double stamp_s = 0;
  /// By corrected odometry: locally good to centimetres, drifts over long distances. The first one
  /// stands at its raw odometry pose.
  Pose T_track_robot;

  bool operator==(const Keyframe&) const = default;
};

/// Every observation hangs on a keyframe.
struct TrackedObservation {
  int64_t observation = 0;
  double stamp_s = 0;
  int keyframe = 0;
  Pose T_keyframe_robot;

  bool operator==(const TrackedObservation&) const = default;
};

/// The robot's way through a log.
struct Track {
  Space space = Space::se2;
  std::vector<Keyframe> keyframes;
  std::vector<TrackedObservation> observations;  ///< all of them, in the order of the log
  std::vector<Constraint> odometry;              ///< k -> k+1 for every keyframe but the last
  LogReport log;

  bool operator==(const Track&) const = default;
};

/// What the front end makes of a log.
struct TrackedLog {
  Track track;
  std::vector<Sighting> sightings;  ///< in the order of the log
  std::vector<int64_t> names;       ///< of landmark 0, 1, ..; kUnknownLandmark without one
};

struct TrackOptions {
  /// A keyframe every so many metres ... [0.05, 10]
  double keyframe_distance_m = 0.5;
  /// ... or radians of motion, [0.02, pi].
  double keyframe_angle_rad = 0.35;
};

/// Reads the log once and corrects its odometry by registering each observation against the recent
/// local map. `keep` is called once for every observation, in order, so that its points can be
/// stored; only a window of recent surfaces is held in memory. An empty log throws InputError.
///
/// Landmarks that have names are sighted from where the observations stand; those without are
/// counted and left out. A log of landmarks alone is followed by these: see track_landmarks().
TrackedLog track_log(LogReader& log, const TrackOptions& options,
                     const std::function<void(const Observation&)>& keep, const Run& run);

}  // namespace hmt::submap
