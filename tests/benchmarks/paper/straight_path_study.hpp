// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "chart.hpp"
#include "straight_path.hpp"

namespace hmt::paper {

/// The k of the fixed submaps that the paper compares with, and its tau [Blanco 2009, Sec. 6.1].
inline constexpr int kLeastFixed = 2;
inline constexpr int kMostFixed = 45;
inline constexpr double kPaperTau = 0.2;

/// Stands for tau -> 0: only components that share nothing at all are parted.
inline constexpr double kTauToZero = 1e-9;

/// Information loss in percent over many runs.
struct StraightPathStudy {
  Statistics ncut;                ///< at tau = 0.2
  double ncut_groups = 0;         ///< mean number of submaps that have seen a landmark
  std::vector<Statistics> fixed;  ///< submaps of k observations, k = 2..45
  std::vector<double> taus;       ///< the first is kTauToZero
  std::vector<Statistics> by_tau;
  std::vector<double> groups_by_tau;

  /// For how many k min-Ncut is lower in the mean, in the standard deviation, and in the length of
  /// the 68 % interval.
  int lower_means() const;
  int lower_deviations() const;
  int lower_intervals() const;
};

/// Runs with the seeds 1..runs; the same result on any number of threads. `taus`: also these,
/// besides kTauToZero and 0.2.
StraightPathStudy study_straight_path(const StraightPathParameters& parameters, int runs,
                                      const std::vector<double>& taus, int threads);

}  // namespace hmt::paper
