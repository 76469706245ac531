// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "noise_components.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "../observation/median.hpp"

namespace hmt::submap {
namespace {

constexpr double kFreedom = 4;
// Mean of (f + 1) / (f + z^2) z^2 for a normal z: with it divided out, what is normal keeps its
// variance.
constexpr double kNormalShare = 0.7863;
constexpr int kIterations = 300;
// Steps of expectation maximization grow small long before they end.
constexpr double kConverged = 1e-4;

NoiseComponents start(std::span<const NoiseSample> samples) {
  std::vector<double> rates, motions;
  for (const NoiseSample& s : samples) {
    rates.push_back(s.difference * s.difference / s.motion);
    motions.push_back(s.motion);
  }
  const double rate = std::max(median(std::move(rates)), 1e-12);
  return {rate, rate * median(std::move(motions))};
}

/// Expected square of a part of the sample whose variance is `part` of `whole`.
double expected_square(double part, double whole, double weighted_square) {
  const double share = part / whole;
  return share * share * weighted_square + part * (1 - share);
}

NoiseComponents improve(std::span<const NoiseSample> samples, const NoiseComponents& before) {
  NoiseComponents sum;
  for (const NoiseSample& s : samples) {
    const double odometry = before.odometry_rate * s.motion;
    const double variance = odometry + before.registration + s.known_variance;
    const double square = s.difference * s.difference;
    const double weighted = (kFreedom + 1) / (kFreedom + square / variance) * square / kNormalShare;
    sum.odometry_rate += expected_square(odometry, variance, weighted) / s.motion;
    sum.registration += expected_square(before.registration, variance, weighted);
  }
  const auto count = static_cast<double>(samples.size());
  return {sum.odometry_rate / count, sum.registration / count};
}

}  // namespace

NoiseComponents separate_noise(std::span<const NoiseSample> samples) {
  if (samples.empty()) return {};
  NoiseComponents now = start(samples);
  for (int k = 0; k < kIterations; ++k) {
    const NoiseComponents before = now;
    now = improve(samples, before);
    if (std::abs(now.odometry_rate - before.odometry_rate) <= kConverged * before.odometry_rate &&
        std::abs(now.registration - before.registration) <= kConverged * before.registration)
      break;
  }
  return now;
}

}  // namespace hmt::submap
