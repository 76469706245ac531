// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// A robot with a planar laser and wheel odometry in a building of walls.
struct SimulationOptions {
  /// `rooms`: three rooms in a row. `corridor`: 100 m long, with niches. `building`: rooms along a
  /// corridor that closes a loop. `symmetric`: many equal rooms along a 200 m corridor. `ring`: 200
  /// m of corridor that closes a loop, with equal rooms.
  std::string world = "building";
  uint64_t seed = 1;
  int laps = 1;  ///< rounds through the building, [1, 1000000]; later ones enter other rooms

  bool operator==(const SimulationOptions&) const = default;
};

/// The names of the worlds.
std::vector<std::string> simulated_worlds();

/// One scan with its truth.
struct SimulatedScan {
  std::vector<double> ranges_m;  ///< as the scanner gives them: 181 beams from -90 deg by 1 deg
  Observation observation;       ///< the same, as a log reader gives it
  Pose T_world_robot;            ///< true
};

/// Delivers scan after scan in constant memory; the same options give the same scans.
class Simulation {
 public:
  /// Throws InputError for an unknown world or laps out of range.
  explicit Simulation(const SimulationOptions& options);
  ~Simulation();
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;

  /// Nothing when the last lap is done.
  std::optional<SimulatedScan> next();
  /// Laps begun so far, for progress.
  int laps_begun() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A whole simulated log in memory.
struct SimulatedLog {
  std::vector<Observation> observations;
  std::vector<Pose> T_world_robot;  ///< true poses of the observations
};

/// All scans of a Simulation.
SimulatedLog simulate(const SimulationOptions& options);

}  // namespace hmt::submap
