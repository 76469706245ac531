// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Scans and clouds that were taken beam by beam while the robot drove and turned.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hmt/submap/log/log_reader.hpp"
#include "log/ros/sweep.hpp"
#include "recordings/recording_writers.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using test::WireWriter;

constexpr int64_t kStart = 1'600'000'000'000'000'000;
constexpr double kSweep_s = 0.1;
constexpr int kBeams = 360;
constexpr double kHalfRoom_m = 5;
const Pose kMount = Pose::planar(0.3, 0.1, 0.5);

/// 2 m/s and 1 rad/s: during a scan 0.2 m and 6 degrees.
Pose robot_at(double seconds) {
  return Pose::planar(2 * std::sin(seconds), 2 * (1 - std::cos(seconds)), seconds);
}

int64_t stamp_at(double seconds) {
  return kStart + static_cast<int64_t>(std::llround(1e9 * seconds));
}

double beam_time(int beam) {
  return kSweep_s * beam / kBeams;
}
double beam_angle(int beam) {
  return 2 * std::numbers::pi * beam / kBeams;
}

/// Range from inside a square room around the origin.
double range_in_room(const Eigen::Vector2d& from, const Eigen::Vector2d& direction) {
  double range = INFINITY;
  for (int k = 0; k < 2; ++k) {
    const double wall = direction[k] > 0 ? kHalfRoom_m : -kHalfRoom_m;
    if (direction[k] != 0) range = std::min(range, (wall - from[k]) / direction[k]);
  }
  return range;
}

/// The beams of a scan that begins at that time, each from where the robot is then.
std::vector<double> scan_at(double seconds) {
  std::vector<double> ranges;
  for (int beam = 0; beam < kBeams; ++beam) {
    const Pose T_world_sensor = robot_at(seconds + beam_time(beam)) * kMount;
    const double angle = T_world_sensor.yaw_rad() + beam_angle(beam);
    ranges.push_back(
        range_in_room(T_world_sensor.translation.head<2>(), {std::cos(angle), std::sin(angle)}));
  }
  return ranges;
}

std::vector<Eigen::Vector3f> points_at(double seconds) {
  std::vector<Eigen::Vector3f> points;
  const std::vector<double> ranges = scan_at(seconds);
  for (int beam = 0; beam < kBeams; ++beam)
    points.push_back(
        (ranges[static_cast<size_t>(beam)] *
         Eigen::Vector3d(std::cos(beam_angle(beam)), std::sin(beam_angle(beam)), 0.01 * beam))
            .cast<float>());
  return points;
}

/// Records odometry at 50 Hz and five scans.
template <class Scan>
std::vector<Observation> record_and_read(const std::string& type, Scan&& scan) {
  std::vector<test::SampleMessage> messages = {
      {"/tf_static", "tf2_msgs/TFMessage", kStart,
       test::transforms(WireWriter(Wire::ros1), {{kStart, "base_link", "laser", kMount}})}};
  for (int k = 0; k <= 100; ++k) {
    const double t = 0.02 * k;
    messages.push_back({"/odom", "nav_msgs/Odometry", stamp_at(t),
                        test::odometry(WireWriter(Wire::ros1), stamp_at(t), robot_at(t))});
    if (k % 20 == 10) messages.push_back({"/scan", type, stamp_at(t + 0.005), scan(t + 0.005)});
  }
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "log.bag", test::ros1_bag(messages));
  const auto reader = open_log(folder.path() / "log.bag");
  std::vector<Observation> observations;
  while (auto observation = reader->next()) observations.push_back(std::move(*observation));
  return observations;
}

/// How far the points, at the pose of their scan, lie off the walls at most.
double worst_distance_to_walls(const std::vector<Observation>& observations) {
  double worst = 0;
  for (const Observation& observation : observations) {
    const Reading& reading = observation.readings.at(0);
    EXPECT_EQ(reading.points_sensor.size(), size_t{kBeams});
    for (const Eigen::Vector3f& p : reading.points_sensor) {
      const Eigen::Vector3d p_world =
          observation.T_odom_robot * reading.T_robot_sensor * p.cast<double>();
      const double off = kHalfRoom_m - p_world.head<2>().lpNorm<Eigen::Infinity>();
      worst = std::max(worst, std::abs(off));
    }
  }
  return worst;
}

// The odometry is interpolated between records, which at 50 Hz is good to a tenth of a millimetre.
constexpr double kGood_m = 2e-3;

std::vector<Observation> with_time_increment(double time_increment_s) {
  return record_and_read("sensor_msgs/LaserScan", [&](double t) {
    test::SampleScan scan{stamp_at(t), "laser", 0, 0, 0, 50, scan_at(t)};
    scan.angle_increment = static_cast<float>(beam_angle(1));
    scan.time_increment = static_cast<float>(time_increment_s);
    return laser_scan(WireWriter(Wire::ros1), scan);
  });
}

TEST(Deskew, LaserScansByTheirTimeIncrement) {
  const auto observations = with_time_increment(kSweep_s / kBeams);
  EXPECT_EQ(observations.size(), 5u);
  EXPECT_LT(worst_distance_to_walls(observations), kGood_m);
}

TEST(Deskew, WithoutTimesOrWithImpossibleOnesScansStayAsTheyAre) {
  for (const double increment : {0.0, -1.0, 0.1, std::nan("")})
    EXPECT_GT(worst_distance_to_walls(with_time_increment(increment)), 0.1) << increment;
}

TEST(Deskew, CloudsByTheTimesOfTheirPointsInTheirUsualUnits) {
  const struct {
    const char* name;
    uint8_t datatype;
    double unit_s;
    double zero_s;  // what the time at the stamp is
    bool from_stamp;
  } kinds[] = {{"time", 7, 1, 0, true},            // Velodyne
               {"time", 7, 1e-6, 0, true},         // the same as some converters write it
               {"t", 6, 1e-9, 0, true},            // Ouster
               {"offset_time", 6, 1e-9, 0, true},  // Livox
               {"timestamp", 8, 1, 1.6e9, false},  // Hesai, Robosense
               {"timestamp", 8, 1e-9, 1.6e9, false},
               {"timestamp", 8, 1, 777, true}};  // a clock that began with the sensor
  for (const auto& kind : kinds) {
    const auto observations = record_and_read("sensor_msgs/PointCloud2", [&](double t) {
      test::SampleTimes times{kind.name, kind.datatype, {}};
      for (int beam = 0; beam < kBeams; ++beam)
        times.values.push_back((kind.zero_s + (kind.from_stamp ? 0 : t) + beam_time(beam)) /
                               kind.unit_s);
      return timed_cloud(WireWriter(Wire::ros1), stamp_at(t), "laser", points_at(t), times);
    });
    EXPECT_EQ(observations.size(), 5u);
    EXPECT_LT(worst_distance_to_walls(observations), kGood_m)
        << kind.name << " in units of " << kind.unit_s << " s";
  }
}

TEST(Deskew, TimesThatAreNoneOfOneScanAreLeft) {
  EXPECT_THAT(beam_times({{0.0, 3e10}}, true, kStart), testing::IsEmpty());
  EXPECT_THAT(beam_times({{0.0, std::nan("")}}, false, kStart), testing::IsEmpty());
  EXPECT_THAT(beam_times({}, false, kStart), testing::IsEmpty());
  // Before the stamp, as of drivers that stamp the end.
  EXPECT_THAT(beam_times({{-0.5, 0.0}}, false, kStart), testing::ElementsAre(-0.5F, 0.0F));
}

TEST(Deskew, WithoutOdometryAroundAllBeamsThereIsNoSweep) {
  PoseHistory odometry;
  odometry.add(0, Pose{});
  odometry.add(100'000'000, Pose::planar(1, 0, 0));
  EXPECT_FALSE(Sweep::along(odometry, {}, 50'000'000, 0, 0.06, {}));
  EXPECT_FALSE(Sweep::along(odometry, {}, 50'000'000, -0.06, 0, {}));
  const auto sweep = Sweep::along(odometry, {}, 50'000'000, -0.05, 0.05, {});
  ASSERT_TRUE(sweep);
  EXPECT_NEAR(sweep->T_stamp_then(0.02).translation.x(), 0.2, 1e-9);
  EXPECT_NEAR(sweep->T_stamp_then(-0.05).translation.x(), -0.5, 1e-9);
}

/// Turns to and fro in its place, 0.1 rad within a scan, faster than odometry at 5 Hz can tell.
double swaying_yaw(double seconds) {
  return 0.3 * std::sin(8 * seconds);
}

// The gyroscope is mounted upside down: its z axis points to the ground.
double worst_of_a_swaying_robot(bool has_gyroscope) {
  const Pose T_robot_imu{Eigen::Vector3d(0.1, 0, 0.2), Eigen::Quaterniond(0, 1, 0, 0)};
  std::vector<test::SampleMessage> messages = {
      {"/tf_static", "tf2_msgs/TFMessage", kStart,
       test::transforms(WireWriter(Wire::ros1), {{kStart, "base_link", "imu", T_robot_imu},
                                                 {kStart, "base_link", "laser", {}}})}};
  for (int k = 0; k <= 400; ++k) {
    const double t = 0.005 * k;
    if (has_gyroscope)
      messages.push_back(
          {"/imu", "sensor_msgs/Imu", stamp_at(t),
           test::imu(WireWriter(Wire::ros1), stamp_at(t), "imu", {0, 0, -2.4 * std::cos(8 * t)})});
    if (k % 40 == 0)
      messages.push_back({"/odom", "nav_msgs/Odometry", stamp_at(t),
                          test::odometry(WireWriter(Wire::ros1), stamp_at(t),
                                         Pose::planar(0, 0, swaying_yaw(t)))});
    if (k % 80 != 40) continue;
    test::SampleScan scan{stamp_at(t), "laser", 0, 0, 0, 50, {}};
    scan.angle_increment = static_cast<float>(beam_angle(1));
    scan.time_increment = static_cast<float>(kSweep_s / kBeams);
    for (int beam = 0; beam < kBeams; ++beam) {
      const double angle = swaying_yaw(t + beam_time(beam)) + beam_angle(beam);
      scan.ranges.push_back(range_in_room({0, 0}, {std::cos(angle), std::sin(angle)}));
    }
    messages.push_back(
        {"/scan", "sensor_msgs/LaserScan", stamp_at(t), laser_scan(WireWriter(Wire::ros1), scan)});
  }
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "log.bag", test::ros1_bag(messages));
  const auto reader = open_log(folder.path() / "log.bag");
  std::vector<Observation> observations;
  while (auto observation = reader->next()) observations.push_back(std::move(*observation));
  EXPECT_EQ(observations.size(), 5u);
  return worst_distance_to_walls(observations);
}

TEST(Deskew, AGyroscopeTellsHowTheRobotTurnedWithinAScan) {
  EXPECT_LT(worst_of_a_swaying_robot(true), kGood_m);
  EXPECT_GT(worst_of_a_swaying_robot(false), 0.1);
}

TEST(TurnRates, AddUpToTheTurnBothWays) {
  TurnRates rates;
  // From 0 to 1 rad/s within 50 ms, then even.
  rates.add(0, {0, 0, 0});
  rates.add(50'000'000, {0, 0, 1});
  rates.add(100'000'000, {0, 0, 1});
  rates.add(300'000'000, {0, 0, 1});
  const auto yaw = [&](int64_t from_ns, int64_t to_ns) {
    const auto turn = rates.turn(from_ns, to_ns);
    return turn ? Pose{Eigen::Vector3d::Zero(), *turn}.yaw_rad() : NAN;
  };
  EXPECT_NEAR(yaw(0, 100'000'000), 0.025 + 0.05, 1e-12);
  EXPECT_NEAR(yaw(75'000'000, 25'000'000), -(0.01875 + 0.025), 1e-12);
  EXPECT_EQ(yaw(20, 20), 0);
  EXPECT_TRUE(std::isnan(yaw(0, 200'000'000))) << "0.2 s without a rate";
  EXPECT_TRUE(std::isnan(yaw(-5, 10)));
  EXPECT_TRUE(std::isnan(yaw(100, 400'000'000)));
}

}  // namespace
}  // namespace hmt::submap
