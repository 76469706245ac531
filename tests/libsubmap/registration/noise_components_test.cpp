// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "noise_components.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "../log/simulation/random.hpp"

namespace hmt::submap {
namespace {

/// Differences over ways of 1, 2, 4 and 8 steps.
std::vector<NoiseSample> samples_of(double odometry_sigma, double registration_sigma,
                                    double known_variance) {
  Random random(7);
  std::vector<NoiseSample> samples;
  for (int k = 0; k < 4000; ++k) {
    const double motion = std::exp2(k % 4);
    samples.push_back({random.normal(odometry_sigma * std::sqrt(motion)) +
                           random.normal(std::hypot(registration_sigma, std::sqrt(known_variance))),
                       motion, known_variance});
  }
  return samples;
}

TEST(NoiseComponents, TellsWhatGrowsWithTheWayFromWhatDoesNot) {
  const NoiseComponents poor_odometry = separate_noise(samples_of(0.1, 0.03, 0));
  EXPECT_NEAR(std::sqrt(poor_odometry.odometry_rate), 0.1, 0.005);
  EXPECT_LT(std::sqrt(poor_odometry.registration), 0.06);
  const NoiseComponents good_odometry = separate_noise(samples_of(0.01, 0.05, 0));
  EXPECT_NEAR(std::sqrt(good_odometry.odometry_rate), 0.01, 0.002);
  EXPECT_NEAR(std::sqrt(good_odometry.registration), 0.05, 0.003);
}

TEST(NoiseComponents, LeavesOutWhatTheRegistrationsClaim) {
  const NoiseComponents noise = separate_noise(samples_of(0.1, 0.0, 0.04));
  EXPECT_NEAR(std::sqrt(noise.odometry_rate), 0.1, 0.02);
  EXPECT_LT(std::sqrt(noise.registration), 0.1);
}

TEST(NoiseComponents, AFewJumpsTeachLittle) {
  std::vector<NoiseSample> samples = samples_of(0.01, 0.01, 0);
  const NoiseComponents without = separate_noise(samples);
  for (size_t k = 0; k < samples.size(); k += 50) samples[k].difference = 10;
  const NoiseComponents with = separate_noise(samples);
  EXPECT_LT(with.odometry_rate, 2 * without.odometry_rate);
  EXPECT_LT(with.registration, 3 * without.registration);
}

TEST(NoiseComponents, NothingIsLearntFromNothing) {
  EXPECT_EQ(separate_noise({}).odometry_rate, 0);
  const std::vector<NoiseSample> exact(20, {0, 1, 0});
  EXPECT_LT(separate_noise(exact).odometry_rate, 1e-11);
}

}  // namespace
}  // namespace hmt::submap
