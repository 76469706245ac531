// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "hmt/submap/log/simulation.hpp"
#include "recording_writers.hpp"

namespace hmt::test {

/// What a robot would have recorded of a simulated drive: a static transform to the laser, then
/// odometry and scan in turn.
inline std::vector<SampleMessage> simulated_messages(const submap::SimulationOptions& options,
                                                     submap::Wire wire, size_t most = SIZE_MAX) {
  constexpr double kDegree = std::numbers::pi / 180;
  std::vector<SampleMessage> messages;
  submap::Simulation simulation(options);
  for (size_t count = 0; count < most; ++count) {
    const auto scan = simulation.next();
    if (!scan) break;
    const auto stamp_ns = static_cast<int64_t>(std::llround(scan->observation.stamp_s * 1e9));
    if (messages.empty())
      messages.push_back(
          {"/tf_static", "tf2_msgs/TFMessage", stamp_ns,
           transforms(WireWriter(wire), {{stamp_ns, "base_link", "laser",
                                          scan->observation.readings.front().T_robot_sensor}})});
    messages.push_back({"/odom", "nav_msgs/Odometry", stamp_ns,
                        odometry(WireWriter(wire), stamp_ns, scan->observation.T_odom_robot)});
    SampleScan sample;
    sample.stamp_ns = stamp_ns;
    sample.angle_min = static_cast<float>(-90 * kDegree);
    sample.angle_increment = static_cast<float>(kDegree);
    sample.range_max = 80;
    sample.ranges = scan->ranges_m;
    messages.push_back({"/scan", "sensor_msgs/LaserScan", stamp_ns + 1'000'000,
                        laser_scan(WireWriter(wire), sample)});
  }
  return messages;
}

}  // namespace hmt::test
