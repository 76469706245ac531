// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace hmt::submap {

/// Difference between what odometry and registration say of a way, in one direction.
struct NoiseSample {
  double difference = 0;
  double motion = 0;          ///< what the variance of odometry grows with, > 0
  double known_variance = 0;  ///< of the registration, as it claims, >= 0
};

/// Whose noise it is: variance = odometry_rate motion + known_variance + registration.
struct NoiseComponents {
  double odometry_rate = 0;
  double registration = 0;  ///< beyond what registration claims
};

/// Most likely components of the variance of samples over ways of several lengths: the noise of
/// odometry grows with the way, that of a registration does not. Expectation maximization from
/// equal shares, with the weights of a Student t distribution of four degrees of freedom, because
/// both have heavy tails, scaled so that normal noise comes out as it is. Without samples both are
/// zero.
NoiseComponents separate_noise(std::span<const NoiseSample> samples);

}  // namespace hmt::submap
