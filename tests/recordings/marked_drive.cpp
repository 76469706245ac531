// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "marked_drive.hpp"

#include <cmath>
#include <numbers>

#include "log/simulation/laser_model.hpp"
#include "log/simulation/random.hpp"
#include "log/simulation/robot_path.hpp"
#include "log/simulation/wheel_odometry.hpp"
#include "marker_messages.hpp"

namespace hmt::test {
namespace {

using graph::Pose;
using submap::FloorPlan;
using submap::Wall;

constexpr double kPeriod_s = 0.5;   // between scans; the camera looks in the middle between two
constexpr double kLatency_s = 0.2;  // until the markers are found
constexpr double kCameraRange_m = 5;
constexpr double kHalfView = 0.8;  // radians
constexpr double kHeight_m = 0.4;  // of the markers over the camera
constexpr double kDegree = std::numbers::pi / 180;

FloorPlan tunnel() {
  static constexpr double kLength = 100;
  FloorPlan plan;
  plan.free.push_back({Eigen::Vector2d(-2, -1.25), Eigen::Vector2d(kLength + 2, 1.25)});
  plan.path = [](int) { return std::vector<Eigen::Vector2d>{{0, 0}, {kLength, 0}, {0, 0}}; };
  return plan;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether a wall stands between the two points.
bool crosses(const Wall& wall, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const Eigen::Vector2d way = to - from;
  const Eigen::Vector2d along = wall.to - wall.from;
  const double area = cross(way, along);
  if (area == 0) return false;
  const double on_way = cross(wall.from - from, along) / area;
  const double on_wall = cross(wall.from - from, way) / area;
  return on_way > 0 && on_way < 1 && on_wall >= 0 && on_wall <= 1;
}

std::map<int64_t, Eigen::Vector2d> place_markers(const std::vector<Wall>& walls, double spacing_m) {
  std::map<int64_t, Eigen::Vector2d> markers;
  if (spacing_m <= 0) return markers;
  for (const Wall& wall : walls) {
    const double length = (wall.to - wall.from).norm();
    for (double at = spacing_m / 2; at < length; at += spacing_m)
      markers.emplace(std::ssize(markers), wall.from + (wall.to - wall.from) * (at / length));
  }
  return markers;
}

/// Its axes look right, down and ahead.
Pose T_robot_camera() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return {{0.15, 0.05, 0.8}, Eigen::Quaterniond(R)};
}

/// What the camera sees of the markers, with noise; its depth is less sure than its bearings.
std::vector<SampleMarker> look(const Pose& T_world_robot, const std::vector<Wall>& walls,
                               const std::map<int64_t, Eigen::Vector2d>& markers,
                               submap::Random& random) {
  const Pose T_world_camera = T_world_robot * T_robot_camera();
  const Eigen::Vector2d eye = T_world_camera.translation.head<2>();
  std::vector<SampleMarker> seen;
  for (const auto& [name, p] : markers) {
    const Eigen::Vector3d p_world(p.x(), p.y(), T_world_camera.translation.z() + kHeight_m);
    const Eigen::Vector3d p_camera = T_world_camera.inverse() * p_world;
    if (std::abs(std::atan2(p_camera.x(), p_camera.z())) > kHalfView ||
        p_camera.norm() > kCameraRange_m || p_camera.z() < 0.3)
      continue;
    const Eigen::Vector2d short_of_it = eye + 0.98 * (p - eye);
    bool is_hidden = false;
    for (const Wall& wall : walls) is_hidden = is_hidden || crosses(wall, eye, short_of_it);
    if (is_hidden) continue;
    const double across = 0.005 * p_camera.norm() + 0.005;
    const double along = 0.02 * p_camera.norm() + 0.01;
    SampleMarker marker;
    marker.name = name;
    marker.position = p_camera + Eigen::Vector3d(random.normal(across), random.normal(across),
                                                 random.normal(along));
    marker.covariance.diagonal() << across * across, across * across, along * along;
    seen.push_back(marker);
  }
  return seen;
}

}  // namespace

MarkedDrive::MarkedDrive(const MarkedDriveOptions& options, submap::Wire wire) {
  const FloorPlan plan =
      options.world == "tunnel" ? tunnel() : submap::make_floor_plan(options.world, options.seed);
  const std::vector<Wall> all_walls = submap::walls(plan);
  const auto all_markers = place_markers(all_walls, options.marker_spacing_m);
  submap::Random random(options.seed);
  const submap::LaserModel laser(all_walls);
  submap::RobotPath robot(plan.path, options.laps);
  submap::WheelOdometry wheels(robot.T_world_robot(), random);
  const Pose T_robot_laser = Pose::planar(0.1, 0, 0);
  messages.push_back({"/tf_static", "tf2_msgs/TFMessage", 1'000'000'000'000,
                      transforms(WireWriter(wire),
                                 {{1'000'000'000'000, "base_link", "laser", T_robot_laser},
                                  {1'000'000'000'000, "base_link", "camera", T_robot_camera()}})});
  struct Pending {
    int64_t stamp_ns;
    std::vector<SampleMarker> seen;
  };
  std::vector<Pending> pending;
  const auto send_markers = [&](int64_t until_ns) {
    while (!pending.empty() && pending.front().stamp_ns + int64_t(kLatency_s * 1e9) <= until_ns) {
      const Pending& p = pending.front();
      messages.push_back({"/tag_detections", "apriltag_ros/AprilTagDetectionArray",
                          p.stamp_ns + int64_t(kLatency_s * 1e9),
                          april_tags(WireWriter(wire), p.stamp_ns, "camera", p.seen)});
      pending.erase(pending.begin());
    }
  };
  int64_t stamp_ns = 1'000'000'000'000;
  bool goes_on = true;
  for (bool with_scan = true; goes_on; with_scan = !with_scan) {
    send_markers(stamp_ns);
    const Pose T_world_robot = robot.T_world_robot();
    const Pose T_odom_robot = wheels.measure(T_world_robot, random);
    messages.push_back({"/odom", "nav_msgs/Odometry", stamp_ns,
                        odometry(WireWriter(wire), stamp_ns, T_odom_robot)});
    if (with_scan) {
      SampleScan scan;
      scan.stamp_ns = stamp_ns;
      scan.angle_min = static_cast<float>(-90 * kDegree);
      scan.angle_increment = static_cast<float>(kDegree);
      scan.range_max = static_cast<float>(options.laser_range_m);
      scan.ranges = laser.scan(T_world_robot * T_robot_laser, random);
      for (double& range : scan.ranges) range = std::min(range, options.laser_range_m + 1);
      messages.push_back({"/scan", "sensor_msgs/LaserScan", stamp_ns + 1'000'000,
                          laser_scan(WireWriter(wire), scan)});
      truth.push_back({static_cast<double>(stamp_ns) * 1e-9, T_world_robot});
    } else {
      std::vector<SampleMarker> seen = look(T_world_robot, all_walls, all_markers, random);
      for (SampleMarker& marker : seen) {
        markers.emplace(marker.name, all_markers.at(marker.name));
        const auto mistaken = options.mistaken.find(marker.name);
        if (mistaken != options.mistaken.end() && robot.laps_begun() > 1)
          marker.name = mistaken->second;
        if (!options.tells_covariance) marker.covariance.setZero();
      }
      sightings += std::ssize(seen);
      if (!all_markers.empty()) pending.push_back({stamp_ns, std::move(seen)});
    }
    goes_on = robot.advance(kPeriod_s / 2);
    stamp_ns += int64_t(kPeriod_s / 2 * 1e9);
  }
  send_markers(INT64_MAX);
}

}  // namespace hmt::test
