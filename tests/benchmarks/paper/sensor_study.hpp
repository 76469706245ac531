// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "hmt/graph/partition.hpp"
#include "hmt/graph/weighted_graph.hpp"
#include "hmt/submap/observation/observation.hpp"

namespace hmt::paper {

/// Observations and the poses they were made from.
struct Drive {
  std::vector<submap::Observation> observations;
  std::vector<submap::Pose> T_world_robot;
};

/// Every so many metres or radians an observation: what the rest of the study partitions.
inline constexpr double kKeyframeDistance_m = 0.5;
inline constexpr double kKeyframeAngle_rad = 0.35;

/// True if the robot has moved far enough since the last keyframe.
bool is_next_keyframe(const submap::Pose& last, const submap::Pose& now);

/// The areas that a set of sensors divides a drive into.
struct SensorAreas {
  std::string name;
  graph::WeightedGraph overlap;
  graph::Labels labels;

  int areas() const;
};

/// How well the poses are known.
struct PoseSigma {
  double m = 0;
  double rad = 0;
};

/// Overlap graph and partition of the drive with what `keep` leaves of each observation.
SensorAreas divide(const std::string& name, const Drive& drive,
                   const std::function<submap::Observation(const submap::Observation&)>& keep,
                   const PoseSigma& sigma, double tau, int threads);

/// Number of areas at other thresholds.
int areas_at(const SensorAreas& sensors, double tau);

/// Fig. 9 as SVG: a row for each set of sensors with the areas on the map, Omega in the order of
/// time, and Omega by area. `walls`: points of the map in world coordinates.
std::string sensors_svg(const std::string& title, const Drive& drive,
                        const std::vector<Eigen::Vector2d>& walls,
                        const std::vector<SensorAreas>& rows);

/// The scan points of every third observation, world coordinates: a map to draw.
std::vector<Eigen::Vector2d> wall_points(const Drive& drive);

}  // namespace hmt::paper
