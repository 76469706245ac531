// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/surface.hpp"

#include "surface_normals.hpp"

namespace hmt::submap {
namespace {

void append_reading(const Reading& reading, Surface& surface) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(reading.points_sensor.size());
  for (const Eigen::Vector3f& p : reading.points_sensor) points.push_back(p.cast<double>());
  const std::vector<PointNormal> normals = is_cloud(reading)
                                               ? cloud_normals(points, reading.beam_step_rad)
                                               : scan_normals(points, reading.beam_step_rad);
  const Eigen::Matrix3d R = reading.T_robot_sensor.rotation_matrix();
  for (size_t i = 0; i < points.size(); ++i) {
    surface.points_robot.push_back(reading.T_robot_sensor * points[i]);
    surface.normals_robot.emplace_back(R * normals[i].normal);
    surface.sigma_m.push_back(normals[i].sigma_m);
    surface.normal_sigma_rad.push_back(normals[i].normal_sigma_rad);
    surface.spacing_m.push_back(normals[i].spacing_m);
  }
}

}  // namespace

Surface make_surface(const Observation& observation) {
  Surface surface;
  for (const Reading& reading : observation.readings) append_reading(reading, surface);
  return surface;
}

}  // namespace hmt::submap
