// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "pose_history.hpp"

#include <cmath>

namespace hmt::submap {

using graph::Pose;

uint64_t stamp_distance(int64_t a_ns, int64_t b_ns) {
  const auto a = static_cast<uint64_t>(a_ns);
  const auto b = static_cast<uint64_t>(b_ns);
  return a_ns > b_ns ? a - b : b - a;
}

int64_t stamp_after(int64_t stamp_ns, double seconds) {
  return static_cast<int64_t>(static_cast<uint64_t>(stamp_ns) +
                              static_cast<uint64_t>(std::llround(1e9 * seconds)));
}

Pose interpolate(const Pose& T_from, const Pose& T_to, double share) {
  // The ends exactly: stamps often coincide.
  if (share <= 0) return T_from;
  if (share >= 1) return T_to;
  return {T_from.translation + share * (T_to.translation - T_from.translation),
          T_from.rotation.slerp(share, T_to.rotation)};
}

bool PoseHistory::add(int64_t stamp_ns, const Pose& T) {
  if (!poses_.try_emplace(stamp_ns, T).second) return false;
  stamps_.push_back(stamp_ns);
  if (stamps_.size() > kMost) {
    poses_.erase(stamps_.front());
    stamps_.pop_front();
  }
  return true;
}

std::optional<Pose> PoseHistory::between(int64_t stamp_ns) const {
  const auto after = poses_.lower_bound(stamp_ns);
  if (after == poses_.end()) return std::nullopt;
  if (after->first == stamp_ns) return after->second;
  if (after == poses_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const uint64_t gap = stamp_distance(after->first, before->first);
  if (gap > static_cast<uint64_t>(kMaxGap_ns)) return std::nullopt;
  const auto passed = static_cast<double>(stamp_distance(stamp_ns, before->first));
  return interpolate(before->second, after->second, passed / static_cast<double>(gap));
}

PoseHistory::Place PoseHistory::nearest_place(int64_t stamp_ns) const {
  const auto after = poses_.lower_bound(stamp_ns);
  if (after == poses_.begin()) return after;
  const auto before = std::prev(after);
  if (after == poses_.end()) return before;
  return stamp_distance(after->first, stamp_ns) < stamp_distance(stamp_ns, before->first) ? after
                                                                                          : before;
}

std::optional<Pose> PoseHistory::at(int64_t stamp_ns) const {
  if (auto T = between(stamp_ns)) return T;
  const auto near = nearest_place(stamp_ns);
  if (near == poses_.end() ||
      stamp_distance(near->first, stamp_ns) > static_cast<uint64_t>(kMaxHold_ns))
    return std::nullopt;
  return near->second;
}

std::optional<Pose> PoseHistory::nearest(int64_t stamp_ns) const {
  const auto near = nearest_place(stamp_ns);
  return near == poses_.end() ? std::nullopt : std::optional(near->second);
}

}  // namespace hmt::submap
