// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "weigh_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../log/simulation/random.hpp"

namespace hmt::submap {
namespace {

constexpr double kTurnPerMetre = 0.005;  // that the odometry adds
const Pose kStep{{1, 0, 0}, Eigen::Quaterniond::Identity()};

Vector6d sigmas(double translation, double tilt, double heading) {
  Vector6d s;
  s << translation, translation, translation, tilt, tilt, heading;
  return s;
}

Vector6d noise(const Vector6d& sigma, Random& random) {
  Vector6d v;
  for (Eigen::Index k = 0; k < 6; ++k) v[k] = random.normal(sigma[k]);
  return v;
}

/// Metre for metre straight on: an odometry that knows tilt but not heading, registrations that
/// know heading better than tilt, claim to know both to 3 mrad, and were believed alone.
std::vector<ChainStep> drive(int steps) {
  Random random(3);
  const Vector6d by_odometry = sigmas(0.02, 0.0002, 0.01);
  const Vector6d by_registration = sigmas(0.01, 0.004, 0.001);
  std::vector<ChainStep> chain;
  // The registration of a keyframe errs in its pose, not in its step: each takes back the last.
  Pose before;
  for (int k = 0; k < steps; ++k) {
    const Pose now = boxplus(Pose{}, noise(by_registration, random));
    ChainStep step;
    step.estimate = before.inverse() * kStep * now;
    before = now;
    step.odometry = boxplus(kStep, noise(by_odometry, random) + kTurnPerMetre * Vector6d::Unit(5));
    step.information = sigmas(0.01, 0.003, 0.003).cwiseAbs2().cwiseInverse().asDiagonal();
    step.has_odometry = true;
    chain.push_back(step);
  }
  return chain;
}

TEST(WeighChain, TakesEachDirectionFromTheOneThatKnowsIt) {
  const std::vector<ChainStep> chain = drive(500);
  const auto weighed = weigh_chain(chain);
  ASSERT_TRUE(weighed);
  Vector6d squares = Vector6d::Zero();
  double chi2 = 0;
  for (const WeighedStep& step : *weighed) {
    const Vector6d error = boxminus(step.T_a_b, kStep);
    squares += error.cwiseAbs2() / 500;
    chi2 += error.dot(step.information * error) / 500;
  }
  EXPECT_LT(std::sqrt(squares[3]), 0.0004) << "registrations alone: 0.0057";
  EXPECT_LT(std::sqrt(squares[5]), 0.002) << "odometry alone: 0.011";
  EXPECT_GT(chi2, 2);
  EXPECT_LT(chi2, 12) << "six directions";
}

TEST(WeighChain, TakesOutWhatOdometryAlwaysDoesWrong) {
  std::vector<ChainStep> chain = drive(500);
  // A step that no registration saw.
  chain[250].information.setZero();
  const auto weighed = weigh_chain(chain);
  ASSERT_TRUE(weighed);
  EXPECT_NEAR((*weighed)[250].T_a_b.yaw_rad(), chain[250].odometry.yaw_rad() - kTurnPerMetre,
              0.3 * kTurnPerMetre);
}

TEST(WeighChain, BelievesNoOdometryThatKnowsNoTilt) {
  // A robot that sways, on wheels that tell no tilt: what they are wrong by does not grow.
  std::vector<ChainStep> chain = drive(500);
  Random random(5);
  Pose before;
  std::vector<Pose> truth;
  for (ChainStep& step : chain) {
    const Pose now = boxplus(Pose{}, random.normal(0.05) * Vector6d::Unit(3));
    truth.push_back(before.inverse() * kStep * now);
    before = now;
    step.estimate = boxplus(truth.back(), noise(sigmas(0.001, 0.001, 0.001), random));
    step.odometry = kStep;
  }
  const auto weighed = weigh_chain(chain);
  ASSERT_TRUE(weighed);
  for (size_t k = 0; k < chain.size(); ++k)
    EXPECT_LT(boxminus((*weighed)[k].T_a_b, truth[k]).tail<3>().norm(), 0.02) << k;
}

TEST(WeighChain, KnowsAStepLessOnWhichTheTwoDisagree) {
  std::vector<ChainStep> chain = drive(500);
  chain[250].odometry = boxplus(chain[250].odometry, Vector6d::Unit(0) * 3);
  const auto weighed = weigh_chain(chain);
  ASSERT_TRUE(weighed);
  EXPECT_LT((*weighed)[250].information(0, 0), 0.01 * (*weighed)[249].information(0, 0));
}

TEST(WeighChain, AStepWithoutOdometryStaysAsItIs) {
  std::vector<ChainStep> chain = drive(500);
  chain[250].has_odometry = false;
  chain[250].odometry = Pose{{1000, 0, 0}, Eigen::Quaterniond::Identity()};
  const auto weighed = weigh_chain(chain);
  ASSERT_TRUE(weighed);
  EXPECT_EQ((*weighed)[250].T_a_b, chain[250].estimate);
  EXPECT_TRUE((*weighed)[250].information.isZero(0));
  EXPECT_LT((*weighed)[249].T_a_b.translation.norm(), 1.1);
}

TEST(WeighChain, LearnsNothingFromAShortLog) {
  EXPECT_FALSE(weigh_chain(drive(50)));
  EXPECT_FALSE(weigh_chain({}));
}

}  // namespace
}  // namespace hmt::submap
