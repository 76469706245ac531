// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/log/simulation.hpp"

#include <numbers>

#include "../range_scan.hpp"
#include "laser_model.hpp"
#include "robot_path.hpp"
#include "wheel_odometry.hpp"

namespace hmt::submap {
namespace {

constexpr double kPeriod = 0.5;       // seconds between scans
constexpr double kFirstStamp = 1000;  // seconds
constexpr double kLaserX = 0.1;       // metres ahead of the robot's middle
constexpr double kDegree = std::numbers::pi / 180;
constexpr int kMaxLaps = 1000000;

SimulationOptions checked(const SimulationOptions& options) {
  if (options.laps < 1 || options.laps > kMaxLaps)
    throw InputError("laps is " + std::to_string(options.laps) + ", must be in [1, " +
                     std::to_string(kMaxLaps) + "]");
  return options;
}

}  // namespace

struct Simulation::Parts {
  explicit Parts(const SimulationOptions& options)
      : plan(make_floor_plan(options.world, options.seed)),
        random(options.seed),
        laser(walls(plan)),
        robot(plan.path, options.laps),
        odometry(robot.T_world_robot(), random) {}

  FloorPlan plan;
  Random random;
  LaserModel laser;
  RobotPath robot;
  WheelOdometry odometry;
  int64_t scans = 0;
  bool done = false;
};

Simulation::Simulation(const SimulationOptions& options)
    : parts_(std::make_unique<Parts>(checked(options))) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

int Simulation::laps_begun() const {
  return parts_->robot.laps_begun();
}

std::optional<SimulatedScan> Simulation::next() {
  if (parts_->done) return std::nullopt;
  SimulatedScan scan;
  scan.T_world_robot = parts_->robot.T_world_robot();
  const Pose T_robot_laser = Pose::planar(kLaserX, 0, 0);
  scan.ranges_m = parts_->laser.scan(scan.T_world_robot * T_robot_laser, parts_->random);

  Observation& observation = scan.observation;
  observation.index = parts_->scans++;
  observation.stamp_s = kFirstStamp + static_cast<double>(observation.index) * kPeriod;
  observation.T_odom_robot = parts_->odometry.measure(scan.T_world_robot, parts_->random);
  Reading reading;
  reading.T_robot_sensor = T_robot_laser;
  reading.max_range_m = LaserModel::kMaxRange;
  add_ranges(scan.ranges_m, LaserModel::kStartAngleDeg * kDegree,
             LaserModel::kBeamStepDeg * kDegree, reading);
  observation.readings.push_back(std::move(reading));

  parts_->done = !parts_->robot.advance(kPeriod);
  return scan;
}

SimulatedLog simulate(const SimulationOptions& options) {
  Simulation simulation(options);
  SimulatedLog log;
  while (auto scan = simulation.next()) {
    log.observations.push_back(std::move(scan->observation));
    log.T_world_robot.push_back(scan->T_world_robot);
  }
  return log;
}

}  // namespace hmt::submap
