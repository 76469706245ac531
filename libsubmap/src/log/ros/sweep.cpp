// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sweep.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

using graph::Pose;

constexpr double kLongestSweep_s = 1;
constexpr double kNanosecond_s = 1e-9;

}  // namespace

std::optional<Sweep> Sweep::along(const PoseHistory& odometry, const TurnRates& turn_rates,
                                  int64_t stamp_ns, double first_s, double last_s,
                                  const Pose& T_robot_sensor) {
  const auto pose_after = [&](double offset_s) {
    return odometry.between(stamp_after(stamp_ns, offset_s));
  };
  const auto T_odom_robot = pose_after(0);
  if (!T_odom_robot) return std::nullopt;
  const Pose T_stamp_odom = (*T_odom_robot * T_robot_sensor).inverse();
  // All of it or nothing: the two may differ by what one of them is wrong.
  const bool has_turn =
      turn_rates.turn(stamp_after(stamp_ns, first_s), stamp_after(stamp_ns, last_s)) &&
      turn_rates.turn(stamp_ns, stamp_after(stamp_ns, last_s));
  Sweep sweep;
  sweep.first_s_ = first_s;
  sweep.step_s_ = (last_s - first_s) / kSteps;
  for (size_t k = 0; k <= kSteps; ++k) {
    const double offset_s = first_s + static_cast<double>(k) * sweep.step_s_;
    auto then = pose_after(offset_s);
    if (!then) return std::nullopt;
    if (has_turn)
      if (const auto turn = turn_rates.turn(stamp_ns, stamp_after(stamp_ns, offset_s)))
        then->rotation = T_odom_robot->rotation * *turn;
    sweep.T_stamp_then_[k] = T_stamp_odom * *then * T_robot_sensor;
  }
  return sweep;
}

Pose Sweep::T_stamp_then(double offset_s) const {
  if (!(step_s_ > 0)) return T_stamp_then_[0];
  const double steps = std::clamp((offset_s - first_s_) / step_s_, 0.0, double{kSteps});
  const size_t before = std::min(static_cast<size_t>(steps), kSteps - 1);
  return interpolate(T_stamp_then_[before], T_stamp_then_[before + 1],
                     steps - static_cast<double>(before));
}

std::vector<float> beam_times(std::span<const double> given, bool in_nanoseconds,
                              int64_t stamp_ns) {
  if (given.empty() || !std::ranges::all_of(given, [](double t) { return std::isfinite(t); }))
    return {};
  const auto [least, greatest] = std::ranges::minmax(given);
  // The largest unit in which it is one scan: floating-point times are seconds, but for some
  // drivers.
  double unit_s = in_nanoseconds ? kNanosecond_s : 1;
  while ((greatest - least) * unit_s > kLongestSweep_s && unit_s > 2 * kNanosecond_s)
    unit_s /= 1000;
  if ((greatest - least) * unit_s > kLongestSweep_s) return {};
  // Since the epoch by the stamp's clock; after the stamp; or by a clock of the sensor's own.
  const double stamp = static_cast<double>(stamp_ns) * kNanosecond_s / unit_s;
  double zero = least;
  if (std::abs(least - stamp) * unit_s <= kLongestSweep_s)
    zero = stamp;
  else if (std::max(std::abs(least), std::abs(greatest)) * unit_s <= kLongestSweep_s)
    zero = 0;
  std::vector<float> times;
  times.reserve(given.size());
  for (const double t : given) times.push_back(static_cast<float>((t - zero) * unit_s));
  return times;
}

}  // namespace hmt::submap
