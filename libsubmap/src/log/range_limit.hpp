// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace hmt::submap {

/// Finds the code by which a scanner says "nothing met": the pile of equal values at the top of its
/// ranges. Scanners differ (50, 81.83, 81.91, 8.19, 5.6 m), and most logs do not tell.
///
/// A pile is taken for the code if it is seen in many beams, from places apart (a far wall changes
/// its range as the robot moves, a code does not), and hardly any range lies just below it.
class RangeLimit {
 public:
  void add(std::span<const double> ranges_m, const Eigen::Vector2d& p_odom);
  /// Ranges at or above this value are misses; nothing while no pile has shown.
  std::optional<double> limit_m() const;

 private:
  void restart(double largest_m, const Eigen::Vector2d& p_odom);

  double largest_m_ = 0;
  int64_t top_ = 0;   ///< ranges in the pile
  int64_t near_ = 0;  ///< ranges just below it
  std::vector<bool> beams_;
  int64_t distinct_beams_ = 0;
  Eigen::Array2d low_ = Eigen::Array2d::Zero();
  Eigen::Array2d high_ = Eigen::Array2d::Zero();
};

}  // namespace hmt::submap
