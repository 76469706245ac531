// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "turn_rates.hpp"

#include <algorithm>

#include "pose_history.hpp"

namespace hmt::submap {
namespace {

Eigen::Quaterniond turned(const Eigen::Vector3d& rate, double seconds) {
  const double angle = rate.norm() * seconds;
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, rate.normalized()));
}

}  // namespace

void TurnRates::add(int64_t stamp_ns, const Eigen::Vector3d& rate_robot) {
  rates_.try_emplace(stamp_ns, rate_robot);
  if (rates_.size() > kMost) rates_.erase(rates_.begin());
}

std::optional<Eigen::Quaterniond> TurnRates::turn(int64_t from_ns, int64_t to_ns) const {
  if (from_ns > to_ns) {
    const auto back = turn(to_ns, from_ns);
    return back ? std::optional(back->inverse()) : std::nullopt;
  }
  auto after = rates_.upper_bound(from_ns);
  if (after == rates_.begin()) return std::nullopt;
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  for (auto before = std::prev(after);; before = after++) {
    if (before->first >= to_ns) return turn;
    if (after == rates_.end()) return std::nullopt;
    const uint64_t gap_ns = stamp_distance(after->first, before->first);
    if (gap_ns > static_cast<uint64_t>(kMaxGap_ns)) return std::nullopt;
    // The rate changes evenly between the two, so its mean over a part is that of the middle.
    const int64_t begin_ns = std::max(from_ns, before->first);
    const int64_t end_ns = std::min(to_ns, after->first);
    const double middle_ns =
        0.5 * static_cast<double>((begin_ns - before->first) + (end_ns - before->first));
    const double share = middle_ns / static_cast<double>(gap_ns);
    const Eigen::Vector3d rate = before->second + share * (after->second - before->second);
    turn = turn * turned(rate, 1e-9 * static_cast<double>(end_ns - begin_ns));
  }
}

}  // namespace hmt::submap
