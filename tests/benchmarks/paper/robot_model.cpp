// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "robot_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "log/range_scan.hpp"
#include "log/simulation/floor_plan.hpp"
#include "log/simulation/laser_model.hpp"
#include "log/simulation/robot_path.hpp"

namespace hmt::paper {
namespace {

using submap::LaserModel;
using submap::Observation;
using submap::Pose;
using submap::Random;
using submap::Wall;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kPeriod_s = 0.1;
// Features on a textured wall that a stereo camera finds again, and how far it sees them.
constexpr double kLandmarkSpacing_m = 0.25;
constexpr double kCameraRange_m = 6;
// A camera with a baseline of 12 cm and 400 pixels of focal length, half a pixel of noise: depth to
// r^2 * 0.5 / (400 * 0.12), direction to 0.5 / 400.
constexpr double kDepthSigma = 0.5 / (400 * 0.12);
constexpr double kDirectionSigma_rad = 0.5 / 400;

std::vector<Eigen::Vector2d> landmarks_on(const std::vector<Wall>& walls, Random& random) {
  std::vector<Eigen::Vector2d> landmarks;
  for (const Wall& wall : walls) {
    const auto count = static_cast<int>((wall.to - wall.from).norm() / kLandmarkSpacing_m);
    for (int i = 0; i < count; ++i)
      landmarks.emplace_back(wall.from + random.uniform() * (wall.to - wall.from));
  }
  return landmarks;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// True if the wall crosses the sight from a to just before b.
bool hides(const Wall& wall, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d sight = b - a;
  const Eigen::Vector2d along = wall.to - wall.from;
  const double area = cross(sight, along);
  if (std::abs(area) < 1e-12) return false;
  const double on_sight = cross(wall.from - a, along) / area;
  const double on_wall = cross(wall.from - a, sight) / area;
  return on_sight > 0 && on_sight < 1 - 1e-6 && on_wall >= 0 && on_wall <= 1;
}

class Robot {
 public:
  Robot(const std::string& world, uint64_t seed)
      : random_(seed),
        plan_(submap::make_floor_plan(world, seed)),
        walls_(submap::walls(plan_)),
        laser_(walls_),
        landmarks_(landmarks_on(walls_, random_)) {}

  const submap::FloorPlan& plan() const { return plan_; }

  Observation observe(const Pose& T_world_robot, int64_t index) {
    Observation observation;
    observation.index = index;
    observation.stamp_s = static_cast<double>(index);
    observation.T_odom_robot = T_world_robot;
    observation.readings.push_back(scan(T_world_robot, kFrontLaser, 0));
    observation.readings.push_back(scan(T_world_robot, kRearLaser, std::numbers::pi));
    observation.landmark_readings.push_back(look(T_world_robot));
    return observation;
  }

 private:
  submap::Reading scan(const Pose& T_world_robot, int sensor, double yaw_rad) {
    submap::Reading reading;
    reading.sensor = sensor;
    reading.T_robot_sensor = Pose::planar(0, 0, yaw_rad);
    reading.max_range_m = LaserModel::kMaxRange;
    submap::add_ranges(laser_.scan(T_world_robot * reading.T_robot_sensor, random_),
                       LaserModel::kStartAngleDeg * kDegree, LaserModel::kBeamStepDeg * kDegree,
                       reading);
    return reading;
  }

  submap::LandmarkReading look(const Pose& T_world_robot) {
    submap::LandmarkReading reading;
    reading.sensor = kCamera;
    const Eigen::Vector2d eye = T_world_robot.translation.head<2>();
    const Pose T_robot_world = T_world_robot.inverse();
    for (size_t i = 0; i < landmarks_.size(); ++i) {
      const Eigen::Vector3d p =
          T_robot_world * Eigen::Vector3d(landmarks_[i].x(), landmarks_[i].y(), 0);
      const double bearing_rad = std::atan2(p.y(), p.x());
      const double range_m = p.norm();
      if (range_m > kCameraRange_m || range_m < 0.1 ||
          std::abs(bearing_rad) > kCameraView_deg / 2 * kDegree)
        continue;
      if (std::any_of(walls_.begin(), walls_.end(),
                      [&](const Wall& wall) { return hides(wall, eye, landmarks_[i]); }))
        continue;
      reading.landmarks.push_back(measure(static_cast<int64_t>(i), range_m, bearing_rad));
    }
    return reading;
  }

  submap::Landmark measure(int64_t id, double range_m, double bearing_rad) {
    const double depth_sigma = kDepthSigma * range_m * range_m;
    const double range = std::max(0.05, range_m + random_.normal(depth_sigma));
    const double bearing = bearing_rad + random_.normal(kDirectionSigma_rad);
    const Eigen::Vector3d along(std::cos(bearing), std::sin(bearing), 0);
    const Eigen::Vector3d across(-along.y(), along.x(), 0);
    submap::Landmark landmark;
    landmark.id = id;
    landmark.position_sensor = range * along;
    landmark.covariance_sensor =
        depth_sigma * depth_sigma * along * along.transpose() +
        std::pow(range * kDirectionSigma_rad, 2) * across * across.transpose();
    return landmark;
  }

  Random random_;
  submap::FloorPlan plan_;
  std::vector<Wall> walls_;
  LaserModel laser_;
  std::vector<Eigen::Vector2d> landmarks_;
};

}  // namespace

Drive simulate_robot(const std::string& world, uint64_t seed) {
  Robot robot(world, seed);
  submap::RobotPath path(robot.plan().path, 1);
  Drive drive;
  std::optional<Pose> last;
  do {
    const Pose T_world_robot = path.T_world_robot();
    if (last && !is_next_keyframe(*last, T_world_robot)) continue;
    last = T_world_robot;
    const auto index = static_cast<int64_t>(drive.observations.size());
    drive.observations.push_back(robot.observe(T_world_robot, index));
    drive.T_world_robot.push_back(T_world_robot);
  } while (path.advance(kPeriod_s));
  return drive;
}

submap::Reading whole_scan(const Observation& observation) {
  submap::Reading whole = observation.readings.at(kFrontLaser);
  const submap::Reading& rear = observation.readings.at(kRearLaser);
  const Pose T_front_rear = graph::relative_pose(whole.T_robot_sensor, rear.T_robot_sensor);
  for (const Eigen::Vector3f& p : rear.points_sensor)
    whole.points_sensor.emplace_back(
        (T_front_rear * Eigen::Vector3d(p.cast<double>())).cast<float>());
  return whole;
}

Drive scan_three_rooms(uint64_t seed) {
  // Rooms of 7 x 6 m beside each other; a stand at the middle of each quarter, the doors without.
  const std::array<Eigen::Vector2d, 14> stands = {{{1.5, 2.0},
                                                   {3.0, 4.2},
                                                   {5.0, 4.0},
                                                   {5.2, 2.2},
                                                   {3.5, 3.0},
                                                   {9.0, 2.5},
                                                   {10.5, 4.2},
                                                   {12.4, 3.8},
                                                   {11.5, 2.0},
                                                   {16.0, 2.6},
                                                   {17.2, 4.0},
                                                   {19.4, 4.4},
                                                   {19.8, 2.4},
                                                   {18.0, 2.2}}};
  Robot robot("rooms", seed);
  Drive drive;
  for (size_t k = 0; k < stands.size(); ++k) {
    const Eigen::Vector2d ahead =
        k + 1 < stands.size() ? Eigen::Vector2d(stands[k + 1] - stands[k]) : Eigen::Vector2d(1, 0);
    const Pose pose = Pose::planar(stands[k].x(), stands[k].y(), std::atan2(ahead.y(), ahead.x()));
    Observation observation = robot.observe(pose, static_cast<int64_t>(k));
    observation.readings = {whole_scan(observation)};
    observation.landmark_readings.clear();
    drive.observations.push_back(std::move(observation));
    drive.T_world_robot.push_back(pose);
  }
  return drive;
}

}  // namespace hmt::paper
