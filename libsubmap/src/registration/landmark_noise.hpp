// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// The observations with all covariances that the log does not tell filled in: those of an ordinary
/// camera or laser on an ordinary wheeled robot. Nothing finer is learnt from the log, because the
/// errors of a landmark's sightings are alike while the robot stays in one view, and a likelihood
/// that does not know this finds noise that is far too small; within a factor of two the map hardly
/// depends on these numbers.
///
/// For the same reason sightings of a named landmark from one view, until the robot has moved by
/// some keyframes, count as one: each gets the variance of one times their number.
///
/// Odometry in the plane of which the log does not tell the covariance is freed of what it does
/// wrong always, as a filter over the log and its named landmarks makes it out.
std::vector<Observation> with_noise(std::vector<Observation> observations, Space space,
                                    const TrackOptions& options);

}  // namespace hmt::submap
