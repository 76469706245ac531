// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "odometry_calibration.hpp"

#include <gtest/gtest.h>

namespace hmt::submap {
namespace {

const Eigen::Matrix2d kNoise = Eigen::Vector2d(1e-5, 1e-6).asDiagonal();

/// Teaches what turns `odometry` into `truth`, step by step.
OdometryCalibration taught(const std::vector<std::pair<Pose, Pose>>& steps, double duration_s) {
  OdometryCalibration calibration;
  for (int round = 0; round < 100; ++round)
    for (const auto& [odometry, truth] : steps) {
      const Vector6d error = graph::boxminus(truth, calibration.corrected(odometry, duration_s));
      calibration.learn(odometry, duration_s, {error[0], error[5]}, kNoise);
    }
  return calibration;
}

TEST(OdometryCalibration, ChangesNothingBeforeItLearns) {
  const Pose step = Pose::planar(0.4, 0.01, 0.2);
  const Pose corrected = OdometryCalibration().corrected(step, 0.5);
  EXPECT_LT(graph::boxminus(corrected, step).norm(), 1e-12);
}

TEST(OdometryErrors, DerivativeIsThatOfTheCorrectedStep) {
  const Pose step = Pose::planar(0.4, 0.05, 0.3);
  const OdometryErrors errors(0.02, -0.1, 0.05, 0.01);
  const auto J = by_odometry_errors(step, 0.5, errors);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 4; ++k) {
    OdometryErrors moved = errors;
    moved[k] += kStep;
    const Vector6d change =
        graph::boxminus(without_errors(step, 0.5, moved), without_errors(step, 0.5, errors));
    EXPECT_LT((change / kStep - J.col(k)).norm(), 1e-5) << k;
  }
}

TEST(OdometryCalibration, LearnsLengthTurnPerMetreAndTurnPerTurn) {
  const auto wrong = [](double x_m, double yaw_rad) {
    return std::pair(Pose::planar(x_m / 1.02, 0, yaw_rad / 1.03 - 0.01 * x_m),
                     Pose::planar(x_m, 0, yaw_rad));
  };
  const OdometryCalibration calibration =
      taught({wrong(0.4, 0), wrong(0, 0.3), wrong(0, -0.3), wrong(0.2, 0)}, 0.5);
  // A step of its own length: a metre along, known to millimetres.
  const Pose found = calibration.corrected(Pose::planar(1 / 1.02, 0, -0.01), 0.5);
  EXPECT_NEAR(found.translation.x(), 1, 2e-3);
  EXPECT_NEAR(found.yaw_rad(), 0, 1e-3);
  EXPECT_NEAR(calibration.corrected(Pose::planar(0, 0, 1 / 1.03), 0.5).yaw_rad(), 1, 3e-3);
}

TEST(OdometryCalibration, NoiseOfTheHeadingTeachesNothingOfTurns) {
  // Straight on, with a heading that jitters by 0.01 rad: to take the jitter for turns would leave
  // a part of the next true one.
  OdometryCalibration calibration;
  for (int k = 0; k < 1000; ++k) {
    const Pose odometry = Pose::planar(0.5, 0, k % 2 == 0 ? 0.01 : -0.01);
    const Vector6d error =
        graph::boxminus(Pose::planar(0.5, 0, 0), calibration.corrected(odometry, 0.5));
    calibration.learn(odometry, 0.5, {error[0], error[5]},
                      Eigen::Vector2d(1e-4, 1e-4).asDiagonal());
  }
  EXPECT_NEAR(calibration.corrected(Pose::planar(0, 0, 1), 1).yaw_rad(), 1, 0.02);
}

TEST(OdometryCalibration, LearnsAGyroThatTurnsAtRest) {
  const OdometryCalibration calibration = taught({{Pose::planar(0, 0, 0.004), Pose{}}}, 1);
  EXPECT_NEAR(calibration.corrected(Pose::planar(0, 0, 0.004), 1).yaw_rad(), 0, 3e-4);
  EXPECT_NEAR(calibration.corrected(Pose::planar(0, 0, 0.008), 2).yaw_rad(), 0, 6e-4);
}

TEST(OdometryCalibration, AWheelThatSlipsTeachesNothing) {
  OdometryCalibration calibration = taught({{Pose::planar(0.4, 0, 0), Pose::planar(0.4, 0, 0)}}, 1);
  const Pose step = Pose::planar(0.4, 0, 0);
  const Pose before = calibration.corrected(step, 1);
  calibration.learn(step, 1, {-0.4, 0.3}, kNoise);
  EXPECT_LT(graph::boxminus(calibration.corrected(step, 1), before).norm(), 1e-4);
}

}  // namespace
}  // namespace hmt::submap
