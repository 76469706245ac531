// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/overlap/overlap.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "walls.hpp"

namespace hmt::submap {
namespace {

using test::room;
using test::scan_walls;

const Matrix6d kCertain = Matrix6d::Zero();

Reading reading_of(std::vector<Eigen::Vector3f> points, double beam_step_rad = 0) {
  Reading reading;
  reading.max_range_m = 20;
  reading.beam_step_rad = beam_step_rad;
  reading.points_sensor = std::move(points);
  return reading;
}

Matrix6d planar_covariance(double x, double y, double yaw) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(0, 0) = x;
  covariance(1, 1) = y;
  covariance(5, 5) = yaw;
  return covariance;
}

Pose tilted_pose() {
  return {{4, -7, 2}, Eigen::Quaterniond(0.7, 0.1, -0.4, 0.5).normalized()};
}

double overlap(const Reading& a, const Reading& b, const Pose& T_a_b = {},
               const Matrix6d& covariance = kCertain) {
  return reading_overlap(a, b, T_a_b, covariance, OverlapOptions{});
}

TEST(ReadingOverlap, TwoOfFourPointsInCommonAreAThird) {
  const Reading a = reading_of({{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}});
  const Reading b = reading_of({{3, 0, 0}, {4, 0, 0}, {5, 0, 0}, {6, 0, 0}});
  EXPECT_DOUBLE_EQ(overlap(a, b), 2.0 / (4 + 4 - 2));
}

TEST(ReadingOverlap, UsesThePoseOfRobotAndSensor) {
  Reading a = reading_of({{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}});
  Reading b = a;
  // The robot moved by 3 m while its sensor was shifted back by 1 m: 3 and 4 of a are 1 and 2 of b.
  b.T_robot_sensor = Pose::planar(-1, 0, 0);
  EXPECT_DOUBLE_EQ(overlap(a, b, Pose::planar(3, 0, 0)), 2.0 / 6.0);
}

TEST(ReadingOverlap, MatchesOfBothDirectionsAreAveraged) {
  // Three points of a lie about the only point of b: (3 + 1) / 2 = 2 matches of 3 + 1 points.
  const Reading a = reading_of({{1.00F, 0, 0}, {1.01F, 0, 0}, {1.02F, 0, 0}});
  const Reading b = reading_of({{1.01F, 0, 0}});
  EXPECT_DOUBLE_EQ(overlap(a, b), 2.0 / (3 + 1 - 2));
}

TEST(ReadingOverlap, GateIsThreeDeviationsOfBothPoints) {
  // Two points at 1 m, beta = 0.01 rad: variance 0.02^2 + (1 * 0.01)^2 = 5e-4 each [Eq. 16], so the
  // difference has a deviation of sqrt(1e-3) and the gate is 3 * 0.0316 = 0.0949 m.
  const Reading point = reading_of({{1, 0, 0}}, 0.01);
  EXPECT_EQ(overlap(point, point, Pose::planar(0, 0.094, 0)), 1.0);
  EXPECT_EQ(overlap(point, point, Pose::planar(0, 0.096, 0)), 0.0);
  EXPECT_EQ(overlap(point, point, Pose::planar(0.094, 0, 0)), 1.0);
  EXPECT_EQ(overlap(point, point, Pose::planar(0.096, 0, 0)), 0.0);
}

TEST(ReadingOverlap, SamplingTermGrowsWithTheRange) {
  // At 10 m, beta = 0.01: variance 4e-4 + 1e-2 each, gate 3 * sqrt(0.0208) = 0.4327 m.
  const Reading point = reading_of({{10, 0, 0}}, 0.01);
  EXPECT_EQ(overlap(point, point, Pose::planar(0, 0.43, 0)), 1.0);
  EXPECT_EQ(overlap(point, point, Pose::planar(0, 0.435, 0)), 0.0);
}

TEST(ReadingOverlap, UncertainHeadingWidensTheGateAcrossTheBeamOnly) {
  // At 1 m a heading variance of 0.003 adds 0.003 m^2 across the beam: the gate is
  // 3 * sqrt(0.001 + 0.003) = 0.190 m there and stays 0.0949 m along the beam.
  const Reading point = reading_of({{1, 0, 0}}, 0.01);
  const Matrix6d heading = planar_covariance(0, 0, 0.003);
  EXPECT_EQ(overlap(point, point, Pose::planar(0, 0.18, 0), heading), 1.0);
  EXPECT_EQ(overlap(point, point, Pose::planar(0, 0.20, 0), heading), 0.0);
  EXPECT_EQ(overlap(point, point, Pose::planar(0.096, 0, 0), heading), 0.0);
}

TEST(ReadingOverlap, CovarianceIsThatOfTheFrameOfB) {
  // b looks along the y axis of a, so its own x uncertainty acts along y of a.
  const Reading a = reading_of({{1, 0, 0}}, 0.01);
  const Matrix6d ahead = planar_covariance(0.003, 0, 0);
  const auto seen_from_turned_b = [&](double dx, double dy) {
    const Pose T_a_b = Pose::planar(1 + dx, -1 + dy, std::numbers::pi / 2);
    return overlap(a, reading_of({{1, 0, 0}}, 0.01), T_a_b, ahead);
  };
  EXPECT_EQ(seen_from_turned_b(0, 0.18), 1.0);
  EXPECT_EQ(seen_from_turned_b(0.10, 0), 0.0);
}

TEST(ReadingOverlap, PointsThatThePoseCannotPlaceMatchNothing) {
  const Reading point = reading_of({{1, 0, 0}}, 0.01);
  EXPECT_EQ(overlap(point, point, {}, planar_covariance(0.08, 0, 0)), 1.0);
  EXPECT_EQ(overlap(point, point, {}, planar_covariance(0.10, 0, 0)), 0.0);
}

TEST(ReadingOverlap, IsZeroForAnEmptyReading) {
  const Reading point = reading_of({{1, 0, 0}});
  const Reading empty = reading_of({});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(overlap(point, empty), 0.0);
  EXPECT_EQ(overlap(empty, point), 0.0);
  EXPECT_EQ(overlap(empty, empty), 0.0);
  EXPECT_EQ(overlap(point, reading_of({{nan, 0, 0}})), 0.0);
}

TEST(ReadingOverlap, IsOneWithItself) {
  const Reading scan = scan_walls(room(-3, -2, 5, 4), Pose::planar(0, 0, 0.3));
  EXPECT_EQ(overlap(scan, scan), 1.0);
  EXPECT_EQ(overlap(scan, scan, {}, planar_covariance(1e-3, 1e-3, 1e-4)), 1.0);
}

TEST(ReadingOverlap, OppositeHeadingsWithHalfAFieldOfViewHaveNone) {
  const auto walls = room(-5, -3, 5, 3);
  const Reading ahead = scan_walls(walls, Pose::planar(0, 0, 0));
  const Reading back = scan_walls(walls, Pose::planar(0, 0, std::numbers::pi));
  EXPECT_LT(overlap(ahead, back, Pose::planar(0, 0, std::numbers::pi)), 0.05);
  const double full = 2 * std::numbers::pi;
  const Reading all_ahead = scan_walls(walls, Pose::planar(0, 0, 0), 361, full);
  const Reading all_back = scan_walls(walls, Pose::planar(0, 0, std::numbers::pi), 361, full);
  EXPECT_GT(overlap(all_ahead, all_back, Pose::planar(0, 0, std::numbers::pi)), 0.95);
}

struct PosedScan {
  Pose T_world_robot;
  Reading reading;
};

std::vector<PosedScan> scans_of_a_room() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-1.5, 1.5), heading(-3, 3);
  std::vector<PosedScan> scans;
  for (int i = 0; i < 12; ++i) {
    const Pose T = Pose::planar(place(random), place(random), heading(random));
    scans.push_back({T, scan_walls(room(-4, -3, 6, 2), T)});
  }
  return scans;
}

TEST(ReadingOverlap, IsSymmetricAndInTheUnitInterval) {
  Matrix6d covariance = planar_covariance(4e-3, 2e-3, 1e-4);
  covariance(0, 5) = covariance(5, 0) = 3e-4;
  const auto scans = scans_of_a_room();
  for (size_t i = 0; i < scans.size(); ++i) {
    for (size_t j = i + 1; j < scans.size(); ++j) {
      const Pose T_i_j = relative_pose(scans[i].T_world_robot, scans[j].T_world_robot);
      const double there = overlap(scans[i].reading, scans[j].reading, T_i_j, covariance);
      const double back = overlap(scans[j].reading, scans[i].reading, T_i_j.inverse(),
                                  graph::inverse_covariance(T_i_j, covariance));
      EXPECT_NEAR(there, back, 1e-9);
      EXPECT_GE(there, 0.0);
      EXPECT_LE(there, 1.0);
    }
  }
}

/// The same with a range noise of 1 cm.
Reading with_noise(Reading reading, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0F, 0.01F);
  for (Eigen::Vector3f& p : reading.points_sensor) p += noise(random) * p.normalized();
  return reading;
}

TEST(ReadingOverlap, ChangesLittleWithASmallMotion) {
  const auto walls = room(-4, -3, 6, 2);
  const Reading a = with_noise(scan_walls(walls, Pose{}), 1);
  const Reading b = with_noise(scan_walls(walls, Pose::planar(0.5, 0.2, 0.4)), 2);
  const Matrix6d covariance = planar_covariance(1e-4, 1e-4, 1e-5);
  double last = overlap(a, b, Pose::planar(0, 0.2, 0.4), covariance);
  for (int mm = 1; mm < 1000; ++mm) {
    const double next = overlap(a, b, Pose::planar(0.001 * mm, 0.2, 0.4), covariance);
    EXPECT_NEAR(next, last, 0.03) << mm;
    last = next;
  }
}

/// Points of a corner of three planes, as a cloud sensor at the pose sees them.
Reading cloud_of_a_corner(const Pose& T_world_robot) {
  Reading reading = reading_of({}, 0.02);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const double u = 0.5 * i, v = 0.5 * j;
      for (const Eigen::Vector3d& p :
           {Eigen::Vector3d(u, v, 0), Eigen::Vector3d(u, 0, v), Eigen::Vector3d(0, u, v)}) {
        reading.points_sensor.push_back((T_world_robot.inverse() * p).cast<float>());
      }
    }
  }
  return reading;
}

TEST(ReadingOverlap, WorksInSpace) {
  const Pose T_world_a{{2, 2, 1}, Eigen::Quaterniond(0.9, 0.1, 0.2, -0.3).normalized()};
  const Pose T_world_b = T_world_a * tilted_pose();
  const Reading a = cloud_of_a_corner(T_world_a), b = cloud_of_a_corner(T_world_b);
  const Pose T_a_b = relative_pose(T_world_a, T_world_b);
  const Matrix6d covariance = 1e-5 * Matrix6d::Identity();
  EXPECT_EQ(overlap(a, b, T_a_b, covariance), 1.0);
  EXPECT_EQ(overlap(a, b, Pose{{0, 0, 40}, {1, 0, 0, 0}} * T_a_b, covariance), 0.0);
  EXPECT_NEAR(overlap(a, b, T_a_b, covariance),
              overlap(b, a, T_a_b.inverse(), graph::inverse_covariance(T_a_b, covariance)), 1e-9);
}

TEST(ObservationOverlap, IsTheMeanOverCommonSensors) {
  Observation a, b;
  a.readings = {reading_of({{1, 0, 0}, {2, 0, 0}}), reading_of({{0, 3, 0}}),
                reading_of({{0, 4, 0}})};
  b.readings = {reading_of({{0, 3, 0}}), reading_of({{1, 0, 0}, {8, 0, 0}})};
  a.readings[0].sensor = 0;
  a.readings[1].sensor = 4;
  a.readings[2].sensor = 5;
  b.readings[0].sensor = 4;
  b.readings[1].sensor = 0;
  // Sensor 0: 1 of 2 + 2 - 1; sensor 4: the same point; sensor 5 is not in b.
  EXPECT_DOUBLE_EQ(observation_overlap(a, b, {}, kCertain, OverlapOptions{}), (1.0 / 3 + 1) / 2);
  EXPECT_EQ(observation_overlap(a, Observation{}, {}, kCertain, OverlapOptions{}), 0.0);
}

TEST(ReadingOverlap, RefusesWhatIsNotANumberOrOutOfRange) {
  const Reading point = reading_of({{1, 0, 0}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(overlap(point, point, {}, Matrix6d::Constant(nan)), InputError);
  EXPECT_THROW(overlap(point, point, Pose::planar(nan, 0, 0)), InputError);
  for (const OverlapOptions& options :
       {OverlapOptions{.max_mahalanobis = 0}, OverlapOptions{.max_pose_deviation_m = nan},
        OverlapOptions{.min_overlap = 1}}) {
    EXPECT_THROW(reading_overlap(point, point, {}, kCertain, options), InputError);
  }
}

}  // namespace
}  // namespace hmt::submap
