// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/track.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

#include "hmt/submap/log/simulation.hpp"
#include "real_data.hpp"
#include "scene.hpp"

namespace hmt::submap {
namespace {

// A log in memory.
class MemoryLog : public LogReader {
 public:
  explicit MemoryLog(std::vector<Observation> observations, Space space = Space::se2)
      : observations_(observations), space_(space) {}
  std::optional<Observation> next() override {
    if (next_ == observations_.size()) return std::nullopt;
    return observations_[next_++];
  }
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return static_cast<int64_t>(next_); }
  int64_t bytes_total() const override { return static_cast<int64_t>(observations_.size()); }
  Space space() const override { return space_; }

 private:
  std::vector<Observation> observations_;
  Space space_;
  size_t next_ = 0;
  LogReport report_;
};

Track track(const std::vector<Observation>& observations) {
  MemoryLog log(observations);
  return track_log(log, {}, {}, {}).track;
}

Pose tracked_pose(const Track& track, size_t i) {
  const TrackedObservation& tracked = track.observations[i];
  return track.keyframes[static_cast<size_t>(tracked.keyframe)].T_track_robot *
         tracked.T_keyframe_robot;
}

// Largest error of the pose of an observation as seen from the one `gap` before.
double largest_error_m(const Track& track, const std::vector<Pose>& truth, size_t gap) {
  double largest = 0;
  for (size_t i = gap; i < truth.size(); ++i) {
    const Pose is = graph::relative_pose(tracked_pose(track, i - gap), tracked_pose(track, i));
    const Pose should = graph::relative_pose(truth[i - gap], truth[i]);
    largest = std::max(largest, (is.translation - should.translation).norm());
  }
  return largest;
}

SimulatedLog rooms() {
  return simulate({.world = "rooms", .seed = 1, .laps = 1});
}

TEST(TrackLog, FollowsASimulatedRobotToCentimetres) {
  const SimulatedLog log = rooms();
  const Track found = track(log.observations);
  ASSERT_EQ(found.observations.size(), log.observations.size());
  EXPECT_LT(largest_error_m(found, log.T_world_robot, 10), 0.05);
  EXPECT_LT(largest_error_m(found, log.T_world_robot, log.T_world_robot.size() - 1), 0.1);
}

TEST(TrackLog, HangsEveryObservationOnAKeyframeNearby) {
  const TrackOptions options;
  const Track found = track(rooms().observations);
  ASSERT_EQ(found.odometry.size() + 1, found.keyframes.size());
  for (size_t i = 0; i < found.observations.size(); ++i) {
    EXPECT_EQ(found.observations[i].observation, static_cast<int64_t>(i));
    EXPECT_LT(found.observations[i].T_keyframe_robot.translation.norm(),
              options.keyframe_distance_m);
  }
  for (const Keyframe& keyframe : found.keyframes) {
    const auto index = static_cast<size_t>(keyframe.observation);
    EXPECT_EQ(found.observations[index].keyframe, keyframe.id);
  }
}

// Mean normalized squared error of the constraints; 3 if all errors were independent, less since
// each constraint allows for the error that a laser's steps of range leave on all beams.
TEST(TrackLog, InformationPredictsTheErrorsOfTheConstraints) {
  const SimulatedLog log = rooms();
  const Track found = track(log.observations);
  const auto truth = [&](int keyframe) {
    const auto k = static_cast<size_t>(keyframe);
    return log.T_world_robot[static_cast<size_t>(found.keyframes[k].observation)];
  };
  double nees = 0;
  for (const Constraint& c : found.odometry) {
    const Vector6d e = boxminus(graph::relative_pose(truth(c.a), truth(c.b)), c.T_a_b);
    nees += e.dot(c.information * e) / static_cast<double>(found.odometry.size());
  }
  EXPECT_GT(nees, 0.3);
  EXPECT_LT(nees, 3.5);
}

TEST(TrackLog, SurvivesOdometryThatJumps) {
  SimulatedLog log = rooms();
  for (size_t i = log.observations.size() / 2; i < log.observations.size(); ++i)
    log.observations[i].T_odom_robot = Pose::planar(100, -50, 2) * log.observations[i].T_odom_robot;
  const Track found = track(log.observations);
  EXPECT_LT(largest_error_m(found, log.T_world_robot, 10), 0.05);
  EXPECT_EQ(found.log.notes.at("odometry jumps, bridged by registration"), 1);
}

TEST(TrackLog, SurvivesOdometryThatTurnsByItself) {
  SimulatedLog log = rooms();
  const std::vector<Observation> original = log.observations;
  for (size_t i = 1; i < original.size(); ++i)
    log.observations[i].T_odom_robot =
        log.observations[i - 1].T_odom_robot *
        graph::relative_pose(original[i - 1].T_odom_robot, original[i].T_odom_robot) *
        Pose::planar(0, 0, 0.05);
  EXPECT_LT(largest_error_m(track(log.observations), log.T_world_robot, 1), 0.1);
}

// The robot backs away by a step, which the wheels count as one more step ahead.
TEST(TrackLog, FindsARobotWhoseOdometryCountsBackwardsAsForwards) {
  constexpr double kStep_m = 1.3;
  const std::vector<double> places_m = {-2, -2 + kStep_m, -2 + 2 * kStep_m, -2 + kStep_m, -2};
  std::mt19937 random(1);
  std::vector<Observation> observations;
  for (size_t i = 0; i < places_m.size(); ++i) {
    const test::Laser laser{.noise_m = 0.01};
    Observation seen = test::scan(test::room(), Pose::planar(places_m[i], 0.5, 0.2), laser, random);
    seen.index = static_cast<int64_t>(i);
    seen.stamp_s = static_cast<double>(i);
    seen.T_odom_robot =
        Pose::planar(kStep_m * static_cast<double>(i), 0, 0) * Pose::planar(0, 0, 0.2);
    observations.push_back(std::move(seen));
  }
  const Track found = track(observations);
  for (size_t i = 0; i < places_m.size(); ++i)
    EXPECT_NEAR(relative_pose(tracked_pose(found, 0), tracked_pose(found, i)).translation.norm(),
                std::abs(places_m[i] - places_m[0]), 0.05)
        << i;
}

/// A corridor along x, 2.5 m wide, with doors four decimetres deep on its left.
std::vector<test::Wall> corridor_with_doors() {
  std::vector<test::Wall> walls{{{-5, -1.25}, {60, -1.25}}};
  double from_m = -5;
  for (const double door_m : {1.0, 9.0, 15.5, 24.0, 31.0, 40.5, 48.0}) {
    walls.push_back({{from_m, 1.25}, {door_m, 1.25}});
    walls.push_back({{door_m, 1.25}, {door_m, 1.65}});
    walls.push_back({{door_m, 1.65}, {door_m + 1, 1.65}});
    walls.push_back({{door_m + 1, 1.65}, {door_m + 1, 1.25}});
    from_m = door_m + 1;
  }
  walls.push_back({{from_m, 1.25}, {60, 1.25}});
  return walls;
}

// Two jambs of a door are all that contradicts the wheels.
TEST(TrackLog, FindsWhereAWheelSlippedAlongACorridor) {
  constexpr double kStep_m = 0.35, kSlip_m = 0.2;
  const std::vector<test::Wall> walls = corridor_with_doors();
  const test::Laser laser{.noise_m = 0.01};
  std::mt19937 random(1);
  std::normal_distribution<double> noise_m(0, 0.01);
  std::vector<Observation> observations;
  std::vector<Pose> truth;
  double wheels_m = 0;
  for (int i = 0; i < 80; ++i) {
    truth.push_back(Pose::planar(kStep_m * i, 0, 0));
    Observation seen = test::scan(walls, truth.back(), laser, random);
    seen.index = i;
    seen.stamp_s = i;
    seen.T_odom_robot = Pose::planar(wheels_m, 0, 0);
    wheels_m += kStep_m + noise_m(random) + (i == 40 || i == 60 ? kSlip_m : 0);
    observations.push_back(std::move(seen));
  }
  EXPECT_LT(largest_error_m(track(observations), truth, 1), kSlip_m / 2);
}

TEST(TrackLog, FollowsARobotWithoutOdometry) {
  SimulatedLog log = rooms();
  // Each scan is searched, which takes its time.
  log.observations.resize(80);
  log.T_world_robot.resize(80);
  for (Observation& observation : log.observations) observation.T_odom_robot = Pose{};
  EXPECT_LT(largest_error_m(track(log.observations), log.T_world_robot, 10), 0.1);
}

/// A lidar that is carried around in a room, 0.4 m at a time, turning by fits and starts, without
/// odometry.
SimulatedLog carried_lidar() {
  SimulatedLog log;
  std::mt19937 random(5);
  for (int k = 0; k < 16; ++k) {
    const double around = 0.2 * k;
    log.T_world_robot.push_back(Pose::planar(1 + 2 * std::cos(around), 1 + 2 * std::sin(around),
                                             around + 0.7 * std::sin(1.1 * k)));
    log.observations.push_back(test::cloud(test::room(), 3, log.T_world_robot.back(), {}, random));
    log.observations.back().index = k;
    log.observations.back().stamp_s = 0.5 * k;
  }
  return log;
}

constexpr auto kLost = "clouds without odometry that fit nowhere, a guess took their place";

TEST(TrackLog, FollowsCloudsWithoutOdometry) {
  const SimulatedLog log = carried_lidar();
  MemoryLog reader(log.observations, Space::se3);
  const Track found = track_log(reader, {}, {}, {}).track;
  EXPECT_LT(largest_error_m(found, log.T_world_robot, 1), 0.02);
  EXPECT_LT(largest_error_m(found, log.T_world_robot, 15), 0.05);
  EXPECT_EQ(found.log.notes.count(kLost), 0);
}

TEST(TrackLog, TellsWhereCloudsWithoutOdometryFitNowhereAndGoesOn) {
  SimulatedLog log = carried_lidar();
  // A room four times as large.
  for (auto& point : log.observations[7].readings[0].points_sensor) point *= 4;
  MemoryLog reader(log.observations, Space::se3);
  const Track found = track_log(reader, {}, {}, {}).track;
  ASSERT_EQ(found.log.notes.count(kLost), 1);
  EXPECT_LE(found.log.notes.at(kLost), 2);
  const Pose is = graph::relative_pose(tracked_pose(found, 9), tracked_pose(found, 15));
  const Pose should = graph::relative_pose(log.T_world_robot[9], log.T_world_robot[15]);
  EXPECT_LT((is.translation - should.translation).norm(), 0.05);
}

TEST(TrackLog, BridgesEmptyScansByOdometry) {
  std::vector<Observation> observations(3);
  for (size_t i = 0; i < observations.size(); ++i) {
    observations[i].index = static_cast<int64_t>(i);
    observations[i].T_odom_robot = Pose::planar(0.6 * static_cast<double>(i), 0, 0);
  }
  const Track found = track(observations);
  ASSERT_EQ(found.keyframes.size(), 3u);
  EXPECT_NEAR(found.keyframes[2].T_track_robot.translation.x(), 1.2, 1e-9);
  ASSERT_EQ(found.odometry.size(), 2u);
  EXPECT_GT(found.odometry[0].information(0, 0), 0);
}

TEST(TrackLog, TurnsAsTheOdometrySaysAfterALongWayStraightOn) {
  // The heading jitters by 0.01 rad. Whoever learns from that how the odometry turns, turns a third
  // of the way where there is nothing to see.
  SimulatedLog log = simulate({.world = "corridor", .seed = 1, .laps = 1});
  log.observations.resize(200);
  Pose T_odom_robot;
  for (size_t i = 0; i < log.observations.size(); ++i) {
    if (i > 0)
      T_odom_robot = T_odom_robot *
                     graph::relative_pose(log.T_world_robot[i - 1], log.T_world_robot[i]) *
                     Pose::planar(0, 0, i % 2 == 0 ? 0.01 : -0.01);
    log.observations[i].T_odom_robot = T_odom_robot;
  }
  Observation turned = log.observations.back();
  ++turned.index;
  turned.stamp_s += 0.5;
  turned.T_odom_robot = T_odom_robot * Pose::planar(0, 0, 1);
  turned.readings.clear();
  log.observations.push_back(turned);
  const Track found = track(log.observations);
  EXPECT_NEAR(graph::relative_pose(tracked_pose(found, 199), tracked_pose(found, 200)).yaw_rad(), 1,
              0.05);
}

TEST(TrackLog, IsRepeatable) {
  const std::vector<Observation> observations = rooms().observations;
  EXPECT_TRUE(track(observations) == track(observations));
}

TEST(TrackLog, HandsOnEveryObservationAndStopsOnRequest) {
  const std::vector<Observation> observations = rooms().observations;
  size_t kept = 0;
  MemoryLog log(observations);
  submap::Run run;
  run.stop = [&] { return kept == 7; };
  EXPECT_THROW(track_log(
                   log, {}, [&](const Observation&) { ++kept; }, run),
               Interrupted);
  EXPECT_EQ(kept, 7u);
}

TEST(TrackLog, RefusesAnEmptyLogAndOptionsOutOfRange) {
  EXPECT_THROW(track({}), InputError);
  MemoryLog log({Observation{}});
  EXPECT_THROW(track_log(log, {.keyframe_distance_m = 0}, {}, {}), InputError);
  EXPECT_THROW(track_log(log, {.keyframe_angle_rad = 4}, {}, {}), InputError);
}

// Mean translation error of the relations [Kuemmerle 2009] inside the first 600 scans.
TEST(TrackLog, AgreesWithTheRelationsOfARealLog) {
  HMT_REQUIRE_REAL_DATA("laser2d/fr079.clf.bz2");
  const auto log = open_log(test::data_dir() / "laser2d/fr079.clf.bz2");
  std::vector<Observation> observations;
  while (observations.size() < 600) observations.push_back(log->next().value());
  const Track found = track(observations);
  const auto nearest = [&](double stamp_s) {
    size_t best = 0;
    for (size_t i = 1; i < observations.size(); ++i)
      if (std::abs(observations[i].stamp_s - stamp_s) <
          std::abs(observations[best].stamp_s - stamp_s))
        best = i;
    return best;
  };
  std::ifstream relations(test::data_dir() / "laser2d/fr079.relations");
  double s1 = 0, s2 = 0, x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0, sum = 0;
  int count = 0;
  while (relations >> s1 >> s2 >> x >> y >> z >> roll >> pitch >> yaw) {
    const size_t i = nearest(s1), j = nearest(s2);
    if (std::abs(observations[i].stamp_s - s1) > 0.01 ||
        std::abs(observations[j].stamp_s - s2) > 0.01)
      continue;
    const Pose is = graph::relative_pose(tracked_pose(found, i), tracked_pose(found, j));
    sum += std::hypot(is.translation.x() - x, is.translation.y() - y);
    ++count;
  }
  ASSERT_GT(count, 30);
  EXPECT_LT(sum / count, 0.04);
}

}  // namespace
}  // namespace hmt::submap
