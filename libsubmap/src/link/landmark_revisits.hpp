// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/registration/sighting.hpp"
#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// What the scans say to landmarks that were seen again.
struct LandmarkRevisits {
  std::vector<Sighting> kept;  ///< in their order
  int contradicted = 0;        ///< visits to a landmark that were to another place
};

/// A marker that hangs at two places, or was carried from one to the other, brings these together:
/// where the scans of two visits to a landmark, registered at the given poses, look through what
/// the other saw, the sightings of the visit with fewer of them are left out. Scans that have
/// nothing in common say nothing. In the plane; in space all are kept.
LandmarkRevisits check_revisits(const Track& track, std::span<const Pose> T_world_keyframe,
                                std::span<const Sighting> sightings,
                                const ObservationStore& observations);

}  // namespace hmt::submap
