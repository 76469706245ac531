// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "hmt/submap/log/simulation.hpp"

namespace hmt::test {

/// How well a simulated building was mapped.
struct BuildingFigures {
  int closures = 0;  ///< accepted loop closures, and registrations between visits
  /// Of these those that are wrong by more than 0.3 m or 0.1 rad, whatever they claim to know.
  int false_closures = 0;
  /// Keyframes at a place (0.5 m, 0.3 rad) where the robot was before, 20 m of travel ago.
  int revisits = 0;
  /// Of these those that a closure ties to the earlier visit: its ends at most five keyframes away.
  int closed = 0;
  double ate_rmse_m = 0;
  /// Normalized estimation error squared of the submaps' poses relative to the first submap, and of
  /// the links: means, 3 where the covariances are exact.
  double submap_nees = 0;
  double link_nees = 0;
  int submaps = 0;
  int links = 0;
};

/// Simulates, maps with default options, and compares with the truth.
BuildingFigures run_building(const submap::SimulationOptions& options, int threads);

}  // namespace hmt::test
