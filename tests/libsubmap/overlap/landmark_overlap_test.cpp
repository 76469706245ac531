// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "hmt/submap/overlap/overlap.hpp"

namespace hmt::submap {
namespace {

const Matrix6d kCertain = Matrix6d::Zero();

Landmark landmark(const Eigen::Vector3d& position, const Eigen::Vector3d& variances,
                  int64_t id = kUnknownLandmark) {
  return {id, position, variances.asDiagonal(), {}};
}

/// Of a planar sensor, known to `variance_m2` in x and y.
Landmark planar(double x, double y, double variance_m2 = 0, int64_t id = kUnknownLandmark) {
  return landmark({x, y, 0}, {variance_m2, variance_m2, 0}, id);
}

LandmarkReading reading_of(std::vector<Landmark> landmarks) {
  LandmarkReading reading;
  reading.landmarks = std::move(landmarks);
  return reading;
}

Matrix6d planar_covariance(double x, double y, double yaw) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance(0, 0) = x;
  covariance(1, 1) = y;
  covariance(5, 5) = yaw;
  return covariance;
}

double overlap(const LandmarkReading& a, const LandmarkReading& b, const Pose& T_a_b = {},
               const Matrix6d& covariance = kCertain) {
  return reading_overlap(a, b, T_a_b, covariance, OverlapOptions{});
}

/// Whether two lonely landmarks are taken for one.
bool match(const Landmark& a, const Landmark& b, const Pose& T_a_b = {},
           const Matrix6d& covariance = kCertain) {
  return overlap(reading_of({a}), reading_of({b}), T_a_b, covariance) > 0;
}

TEST(LandmarkOverlap, TwoOfThreeAndFourInCommonAreTwoFifths) {
  const LandmarkReading a = reading_of({planar(1, 0), planar(2, 5), planar(3, 1)});
  const LandmarkReading b = reading_of({planar(9, 9), planar(3, 1), planar(2, 5), planar(8, 0)});
  EXPECT_DOUBLE_EQ(overlap(a, b), 2.0 / (3 + 4 - 2));
  EXPECT_EQ(overlap(a, a), 1.0);
  EXPECT_EQ(overlap(a, reading_of({})), 0.0);
  EXPECT_EQ(overlap(reading_of({}), reading_of({})), 0.0);
}

TEST(LandmarkOverlap, GateIsThreeDeviationsOfBothMeasurements) {
  // Variances 0.01 + 0.03 = 0.04: the difference has a deviation of 0.2 m, the gate is 0.6 m.
  const auto at = [](double dx, double dy) {
    return match(planar(5, 5, 0.01), planar(5 + dx, 5 + dy, 0.03));
  };
  EXPECT_TRUE(at(0.599, 0));
  EXPECT_FALSE(at(0.601, 0));
  EXPECT_TRUE(at(0, -0.599));
  // Along the diagonal the two differences add up: 0.42^2 + 0.42^2 = 0.594^2.
  EXPECT_TRUE(at(0.42, 0.42));
  EXPECT_FALSE(at(0.43, 0.43));
}

TEST(LandmarkOverlap, MeasurementCovarianceTurnsWithSensorAndRobot) {
  // b is known to 0.3 m along the x axis of its sensor and exactly across it. The sensor is turned
  // by 90 degrees on the robot, so its x axis is the y axis of a.
  const Landmark a = planar(0, 4);
  const auto at = [&](double dx, double dy) {
    LandmarkReading b = reading_of({landmark({4 + dy, -dx, 0}, {0.09, 0, 0})});
    b.T_robot_sensor = Pose::planar(0, 0, std::numbers::pi / 2);
    return overlap(reading_of({a}), b) > 0;
  };
  EXPECT_TRUE(at(0, 0.89));
  EXPECT_FALSE(at(0, 0.91));
  EXPECT_FALSE(at(0.01, 0));
}

TEST(LandmarkOverlap, PoseCovarianceIsPropagatedToTheLandmark) {
  // Seen at 10 m ahead: a heading variance of 4e-4 moves it by 10^2 * 4e-4 = 0.04 m^2 across, and
  // the gate with the measurements (0.01 each) is 3 * sqrt(0.06) = 0.735 m there, 3 * sqrt(0.02) =
  // 0.424 m ahead [Eq. 15].
  const Matrix6d heading = planar_covariance(0, 0, 4e-4);
  const auto at = [&](double dx, double dy) {
    return match(planar(10, 0, 0.01), planar(10, 0, 0.01), Pose::planar(dx, dy, 0), heading);
  };
  EXPECT_TRUE(at(0, 0.73));
  EXPECT_FALSE(at(0, 0.74));
  EXPECT_TRUE(at(0.42, 0));
  EXPECT_FALSE(at(0.43, 0));
}

TEST(LandmarkOverlap, InSpaceTheHeightCounts) {
  const Eigen::Vector3d variances(0.01, 0.01, 0.04);
  const auto at = [&](double dz) {
    return match(landmark({3, 2, 1}, variances), landmark({3, 2, 1 + dz}, variances));
  };
  // 3 * sqrt(0.04 + 0.04) = 0.8485 m.
  EXPECT_TRUE(at(0.84));
  EXPECT_FALSE(at(0.85));
  // A planar sensor knows nothing but the plane.
  EXPECT_TRUE(match(planar(3, 2, 0.01), planar(3.1, 2, 0.01)));
  EXPECT_FALSE(match(planar(3, 2, 0.01), landmark({3, 2, 0.5}, {0.01, 0.01, 0})));
}

TEST(LandmarkOverlap, MatchesOneToOne) {
  // Two of a lie at the only one of b: one match of 2 + 1 - 1.
  const LandmarkReading a = reading_of({planar(1, 0, 0.01), planar(1.1, 0, 0.01)});
  EXPECT_DOUBLE_EQ(overlap(a, reading_of({planar(1, 0, 0.01)})), 0.5);
}

TEST(LandmarkOverlap, TheSmallestDistanceGoesFirst) {
  //  b1      a0         b0 a1      gate 1.27 m: by index a0 would take b0 and leave a1 alone.
  // -0.8     0          0.9 1
  const LandmarkReading a = reading_of({planar(0, 0, 0.09), planar(1, 0, 0.09)});
  const LandmarkReading b = reading_of({planar(0.9, 0, 0.09), planar(-0.8, 0, 0.09)});
  EXPECT_EQ(overlap(a, b), 1.0);
  EXPECT_EQ(overlap(b, a), 1.0);
}

TEST(LandmarkOverlap, TiesAreBrokenAlikeInBothDirections) {
  // A row of equal steps, each within the gate of its neighbours only.
  //   a0  b0  a1  b1  a2
  const LandmarkReading a =
      reading_of({planar(0, 0, 0.09), planar(2, 0, 0.09), planar(4, 0, 0.09)});
  const LandmarkReading b = reading_of({planar(1, 0, 0.09), planar(3, 0, 0.09)});
  EXPECT_DOUBLE_EQ(overlap(a, b), 2.0 / (3 + 2 - 2));
  EXPECT_DOUBLE_EQ(overlap(b, a), 2.0 / (3 + 2 - 2));
}

TEST(LandmarkOverlap, TheSameNameIsTheSameLandmark) {
  const Matrix6d vague = planar_covariance(100, 100, 1);
  EXPECT_TRUE(match(planar(1, 0, 0, 7), planar(40, 3, 0, 7)));
  EXPECT_TRUE(match(planar(1, 0, 0, 7), planar(40, 3, 0, 7), Pose{}, vague));
  EXPECT_FALSE(match(planar(1, 0, 0.01, 7), planar(1, 0, 0.01, 8)));
  // What one of both has no name for is judged by its place.
  EXPECT_TRUE(match(planar(1, 0, 0.01, 7), planar(1, 0, 0.01)));
  EXPECT_FALSE(match(planar(1, 0, 0.01, 7), planar(3, 0, 0.01)));
  // The name has its counterpart already; the unnamed one beside it stays alone.
  const LandmarkReading a = reading_of({planar(1, 0, 0.01, 7)});
  const LandmarkReading b = reading_of({planar(1, 0, 0.01), planar(9, 0, 0.01, 7)});
  EXPECT_DOUBLE_EQ(overlap(a, b), 1.0 / 2);
}

TEST(LandmarkOverlap, ThePoseMayMoveALandmarkHalfWayToTheNext) {
  // Deviation 0.4 m in x: more than what points may have.
  const Matrix6d x = planar_covariance(0.16, 0, 0);
  const auto spaced = [](double spacing) {
    return reading_of({planar(0, 0, 0.01), planar(0, spacing, 0.01)});
  };
  EXPECT_EQ(overlap(spaced(2.41), spaced(2.41), {}, x), 1.0);
  EXPECT_EQ(overlap(spaced(2.39), spaced(2.39), {}, x), 0.0);
  // Alone, it has the limit of points.
  EXPECT_FALSE(match(planar(0, 0, 0.01), planar(0, 0, 0.01), {}, x));
  EXPECT_TRUE(match(planar(0, 0, 0.01), planar(0, 0, 0.01), {}, planar_covariance(0.08, 0, 0)));
}

TEST(LandmarkOverlap, DescriptorsOfTwoLandmarksForbidAMatch) {
  // Within a reading descriptors are sqrt(2) apart, so more than 0.707 means two landmarks.
  const auto looking_like = [](double x, std::vector<float> descriptor) {
    Landmark l = planar(x, 0, 0.01);
    l.descriptor = std::move(descriptor);
    return l;
  };
  const LandmarkReading a = reading_of({looking_like(0, {1, 0}), looking_like(5, {0, 1})});
  EXPECT_EQ(overlap(a, a), 1.0);
  EXPECT_DOUBLE_EQ(overlap(a, reading_of({looking_like(0, {0.6F, 0})})), 1.0 / 2);
  EXPECT_DOUBLE_EQ(overlap(a, reading_of({looking_like(0, {0.2F, 0})})), 0.0);
  // The nearer one looks otherwise; without a descriptor only the place counts.
  EXPECT_DOUBLE_EQ(overlap(a, reading_of({looking_like(5, {1, 0})})), 0.0);
  EXPECT_DOUBLE_EQ(overlap(a, reading_of({looking_like(5, {})})), 1.0 / 2);
}

TEST(LandmarkOverlap, DescriptorsChooseAmongNeighbors) {
  const auto looking_like = [](double x, double y, float what) {
    Landmark l = planar(x, y, 0.01);
    l.descriptor = {what};
    return l;
  };
  // Both of a are near the first of b; the second of b reaches only the first of a. By place alone
  // the nearer pair a0, b0 would leave one match.
  const LandmarkReading a =
      reading_of({looking_like(0, 0, 1), looking_like(0.3, 0, 3), looking_like(9, 9, 9)});
  const LandmarkReading b =
      reading_of({looking_like(0.1, 0, 3), looking_like(-0.25, 0, 1), looking_like(-9, 9, 10)});
  EXPECT_DOUBLE_EQ(overlap(a, b), 2.0 / (3 + 3 - 2));
}

TEST(LandmarkOverlap, LeavesOutPlacesThatAreNotFiniteAndRefusesWhatIsNoCovariance) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const LandmarkReading good = reading_of({planar(1, 0)});
  EXPECT_EQ(overlap(good, reading_of({planar(nan, 0), planar(1, 0)})), 1.0);
  EXPECT_THROW(overlap(good, reading_of({planar(1, 0, nan)})), InputError);
  EXPECT_THROW(overlap(reading_of({planar(1, 0, -0.1)}), good), InputError);
  EXPECT_THROW(overlap(good, good, Pose::planar(nan, 0, 0)), InputError);
  EXPECT_THROW(overlap(good, good, {}, Matrix6d::Constant(nan)), InputError);
}

TEST(ObservationOverlap, CountsRangeSensorsAndLandmarksAlike) {
  Observation a, b;
  Reading scan;
  scan.points_sensor = {{1, 0, 0}, {2, 0, 0}};
  a.readings = b.readings = {scan};
  b.readings[0].points_sensor = {{1, 0, 0}, {8, 0, 0}};
  LandmarkReading trees = reading_of({planar(1, 0), planar(2, 0)});
  trees.sensor = 1;
  a.landmark_readings = b.landmark_readings = {trees};
  const auto both = [&] { return observation_overlap(a, b, {}, kCertain, OverlapOptions{}); };
  // The scans share one of three points, the landmarks all.
  EXPECT_DOUBLE_EQ(both(), (1.0 / 3 + 1) / 2);
  // Sensed nothing in b: nothing in common. In both: it says nothing.
  b.landmark_readings[0].landmarks.clear();
  EXPECT_DOUBLE_EQ(both(), (1.0 / 3 + 0) / 2);
  a.landmark_readings[0].landmarks.clear();
  EXPECT_DOUBLE_EQ(both(), 1.0 / 3);
  // A sensor without a reading in b is left out.
  a.landmark_readings = {trees};
  b.landmark_readings.clear();
  EXPECT_DOUBLE_EQ(both(), 1.0 / 3);
  b.readings.clear();
  EXPECT_EQ(both(), 0.0);
}

}  // namespace
}  // namespace hmt::submap
