// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// Reads a log of landmarks once and follows the robot by a Kalman filter over its pose and the
/// landmarks seen most recently. A name in the log is a landmark; measurements without one are
/// associated by Mahalanobis distance, one to one, and ambiguous ones are left out. Covariances
/// that the log does not tell are those of an ordinary sensor on an ordinary robot.
///
/// A keyframe begins where the robot has moved by what `options` say and the one before saw as many
/// landmarks as fix a pose, so that each sees something. It holds what all observations saw that
/// hang on it. `keep` is called once for every observation, in order, with all covariances. Memory
/// grows with the log. An empty log throws InputError.
TrackedLog track_landmarks(LogReader& log, const TrackOptions& options,
                           const std::function<void(const Observation&)>& keep, const Run& run);

}  // namespace hmt::submap
