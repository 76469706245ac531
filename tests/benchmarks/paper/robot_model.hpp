// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include "sensor_study.hpp"

namespace hmt::paper {

/// Sensors of the simulated robot, the numbers of their readings.
enum RobotSensor { kFrontLaser = 0, kRearLaser = 1, kCamera = 2 };

/// The field of view of the camera [Blanco 2009, Sec. 6.2].
inline constexpr double kCameraView_deg = 65;

/// A robot like the paper's drives through a simulated world (of `hmtmap simulate`): a laser of 180
/// deg forward, one backward, and a stereo camera of 65 deg that sees point landmarks on the walls.
/// Observations at keyframes, at their true poses. Landmarks are named, as matched descriptors
/// would name them.
Drive simulate_robot(const std::string& world, uint64_t seed);

/// A scan of all directions at a pose: both lasers as one sensor.
submap::Reading whole_scan(const submap::Observation& observation);

/// 14 scans of both lasers as one, from stands in the three rooms of the world `rooms`.
Drive scan_three_rooms(uint64_t seed);

}  // namespace hmt::paper
