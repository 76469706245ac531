// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hmt/submap/export/trajectory.hpp"
#include "log/simulation/floor_plan.hpp"
#include "recording_writers.hpp"

namespace hmt::test {

/// A robot with a laser, and with a camera that recognizes markers on the walls.
struct MarkedDriveOptions {
  std::string world = "rooms";  ///< of the simulation, or "tunnel": 100 m of bare walls
  uint64_t seed = 1;
  int laps = 1;
  double laser_range_m = 80;     ///< beams that would go further show a miss
  double marker_spacing_m = 4;   ///< along each wall; 0: none
  bool tells_covariance = true;  ///< of the markers
  /// From the second lap on the camera takes these markers for others.
  std::map<int64_t, int64_t> mistaken = {};
};

struct MarkedDrive {
  MarkedDrive(const MarkedDriveOptions& options, submap::Wire wire);

  std::vector<SampleMessage> messages;
  std::vector<submap::StampedPose> truth;      ///< at the stamps of the scans
  std::map<int64_t, Eigen::Vector2d> markers;  ///< where those are that were seen, by name
  int64_t sightings = 0;
};

}  // namespace hmt::test
