// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "range_limit.hpp"

#include <cmath>

namespace hmt::submap {
namespace {

// The codes of one SICK scanner (81.83, 81.87, 81.89, 81.91: different reasons) lie within 0.1 %.
constexpr double kTopShare = 0.9985;
constexpr double kNearShare = 0.97;
constexpr int64_t kMinTop = 20;
constexpr int64_t kMinBeams = 8;
constexpr double kMinTravel = 2;  // metres
constexpr double kMaxNearPerTop = 0.2;

}  // namespace

void RangeLimit::restart(double largest_m, const Eigen::Vector2d& p_odom) {
  near_ = largest_m * kNearShare <= largest_m_ ? top_ : 0;
  largest_m_ = largest_m;
  top_ = distinct_beams_ = 0;
  beams_.clear();
  low_ = high_ = p_odom.array();
}

void RangeLimit::add(std::span<const double> ranges_m, const Eigen::Vector2d& p_odom) {
  for (size_t beam = 0; beam < ranges_m.size(); ++beam) {
    const double range_m = ranges_m[beam];
    if (!std::isfinite(range_m) || range_m < kNearShare * largest_m_) continue;
    if (range_m * kTopShare > largest_m_) restart(range_m, p_odom);
    if (range_m < kTopShare * largest_m_) {
      ++near_;
      continue;
    }
    ++top_;
    low_ = low_.min(p_odom.array());
    high_ = high_.max(p_odom.array());
    if (beams_.size() <= beam) beams_.resize(beam + 1, false);
    if (!beams_[beam]) ++distinct_beams_;
    beams_[beam] = true;
  }
}

std::optional<double> RangeLimit::limit_m() const {
  const bool pile = top_ >= kMinTop && distinct_beams_ >= kMinBeams &&
                    (high_ - low_).matrix().norm() >= kMinTravel &&
                    static_cast<double>(near_) <= kMaxNearPerTop * static_cast<double>(top_);
  return pile ? std::optional(kTopShare * largest_m_) : std::nullopt;
}

}  // namespace hmt::submap
