// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// An observation and where a trajectory puts it.
struct PosedObservation {
  int64_t observation = 0;  ///< its index in the log
  Pose T_world_robot;
};

/// The observations whose stamps are in a trajectory (within evaluate_trajectory's tolerance), at
/// its poses, in the order of the log.
std::vector<PosedObservation> observations_along(const Track& track,
                                                 std::span<const StampedPose> trajectory);

/// How crisp the map is that a trajectory makes of a log; needs no truth. Errors of the poses make
/// walls thick and double, which fills more cells.
struct MapQuality {
  int64_t scans = 0;
  int64_t beams = 0;           ///< that hit something
  int64_t occupied_cells = 0;  ///< cubes of 5 cm with a hit
  double cells_per_1000_beams = 0;
  /// Mean over all patches of wall of the width, twice the standard deviation of the points along
  /// the wall's normal. A patch is what lies in a cube of 0.3 m and faces the same way, to 45 deg,
  /// with eight points from two scans at least.
  double mean_wall_thickness_m = 0;
  int64_t wall_patches = 0;
};

MapQuality map_quality(const ObservationStore& store, std::span<const PosedObservation> posed);

}  // namespace hmt::submap
