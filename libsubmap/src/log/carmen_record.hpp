// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hmt/graph/pose.hpp"

namespace hmt::submap {

/// One laser scan as a line of a CARMEN log gives it.
struct CarmenScan {
  std::vector<double> ranges_m;  ///< beam i at start_angle_rad + i * beam_step_rad
  double start_angle_rad = 0;
  double beam_step_rad = 0;
  double max_range_m = 0;  ///< 0 where the line does not tell
  graph::Pose T_odom_laser;
  graph::Pose T_odom_robot;
  std::optional<double> stamp_s;  ///< the first of the line's two stamps, that of the sensor
  int stamp_fields = 0;           ///< fields after the poses: stamp, host, stamp of the logger
};

/// FLASER or RLASER: `n r1..rn  x y theta  odom_x odom_y odom_theta  stamp host logger_stamp`,
/// laser pose first, then robot pose; the last three fields may be absent.
///
/// The line does not tell the angles. SICK scanners: beam 0 at -90 deg, steps of 1 deg for 180 and
/// 181 beams and of 0.5 deg for 360 and 361; 400 and 401 beams are the 100 deg mode, steps of 0.25
/// deg from -50 deg. Any other count spreads over 180 deg, ends included; a lone beam looks ahead.
///
/// `fields` is the line after the message name. Throws std::invalid_argument with the reason.
CarmenScan parse_flaser(std::string_view fields);

/// ROBOTLASERn: `type start_angle field_of_view angular_resolution maximum_range accuracy
/// remission_mode  n r1..rn  m s1..sm  laser_x laser_y laser_theta  robot_x robot_y robot_theta
/// tv rv forward_safety_dist side_safety_dist turn_axis  stamp host logger_stamp`. An angular
/// resolution of 0 means field_of_view / (n - 1). Throws std::invalid_argument with the reason.
CarmenScan parse_robotlaser(std::string_view fields);

/// The value of a `PARAM name value ...` line that sets the maximum range of the front laser;
/// nothing for other parameters. `fields` is the line after the message name.
std::optional<double> parse_max_range_param(std::string_view fields);

}  // namespace hmt::submap
