// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/surface.hpp"

#include <algorithm>

#include "surface_normals.hpp"

namespace hmt::submap {
namespace {

// More points of a cloud tell hardly more of six unknowns, but take their time.
constexpr size_t kMostCloudPoints = 10000;

void append_reading(const Reading& reading, Surface& surface) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(reading.points_sensor.size());
  for (const Eigen::Vector3f& p : reading.points_sensor) points.push_back(p.cast<double>());
  const bool cloud = is_cloud(reading);
  const size_t every =
      cloud ? std::max<size_t>(1, (points.size() + kMostCloudPoints - 1) / kMostCloudPoints) : 1;
  const std::vector<PointNormal> normals = cloud
                                               ? cloud_normals(points, reading.beam_step_rad, every)
                                               : scan_normals(points, reading.beam_step_rad);
  const Eigen::Matrix3d R = reading.T_robot_sensor.rotation_matrix();
  for (size_t k = 0; k < normals.size(); ++k) {
    surface.points_robot.push_back(reading.T_robot_sensor * points[k * every]);
    surface.normals_robot.emplace_back(R * normals[k].normal);
    surface.sigma_m.push_back(normals[k].sigma_m);
    surface.normal_sigma_rad.push_back(normals[k].normal_sigma_rad);
    surface.spacing_m.push_back(normals[k].spacing_m);
  }
}

}  // namespace

Surface make_surface(const Observation& observation) {
  Surface surface;
  for (const Reading& reading : observation.readings) append_reading(reading, surface);
  return surface;
}

}  // namespace hmt::submap
