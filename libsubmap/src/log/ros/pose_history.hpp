// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "hmt/graph/pose.hpp"

namespace hmt::submap {

/// The recent poses of one frame in another, by their stamps: the last kMost that were recorded, in
/// whatever order.
class PoseHistory {
 public:
  /// Some seconds of the fastest odometry there is.
  static constexpr size_t kMost = 2000;
  /// Between two poses that lie further apart nothing is known.
  static constexpr int64_t kMaxGap_ns = 1'000'000'000;
  /// Before the first and behind the last pose it stands for so long.
  static constexpr int64_t kMaxHold_ns = 200'000'000;

  /// False for a stamp that is there already: the first pose of it stays.
  bool add(int64_t stamp_ns, const graph::Pose& T);
  /// The pose at a stamp, by linear interpolation between its neighbours; nothing where these are
  /// more than kMaxGap_ns apart.
  std::optional<graph::Pose> between(int64_t stamp_ns) const;
  /// The same; else the nearest pose, if that is within kMaxHold_ns.
  std::optional<graph::Pose> at(int64_t stamp_ns) const;
  /// The pose whose stamp is nearest, however far; nothing if there is none at all.
  std::optional<graph::Pose> nearest(int64_t stamp_ns) const;
  bool empty() const { return poses_.empty(); }

 private:
  using Place = std::map<int64_t, graph::Pose>::const_iterator;
  Place nearest_place(int64_t stamp_ns) const;

  std::map<int64_t, graph::Pose> poses_;
  std::deque<int64_t> stamps_;  ///< in the order in which they were recorded
};

/// |a - b| without overflow, whatever a damaged log says.
uint64_t stamp_distance(int64_t a_ns, int64_t b_ns);

/// The stamp so many seconds later, without overflow.
int64_t stamp_after(int64_t stamp_ns, double seconds);

/// The pose at `share`, in [0, 1], of the way from one to another.
graph::Pose interpolate(const graph::Pose& T_from, const graph::Pose& T_to, double share);

}  // namespace hmt::submap
