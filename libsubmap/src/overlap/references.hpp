// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "hmt/graph/weighted_graph.hpp"

namespace hmt::submap {

/// Which keyframes stand for the places that they were taken at. All pairs of keyframes of a robot
/// that goes its rounds for hours are as many as the square of the rounds, and the tenth visit to a
/// place tells hardly more of the eleventh than the first few do. So a keyframe is a reference
/// unless earlier ones of other visits show well enough what it shows, and a pair counts if its
/// earlier keyframe is a reference or both belong to one visit. References become no more once
/// every place has some: arcs grow with the keyframes, as those of anchor graphs [Liu 2010], and so
/// do registrations.
class References {
 public:
  /// All keyframes are references at first.
  explicit References(int num_keyframes)
      : is_reference_(static_cast<size_t>(num_keyframes), char{1}) {}

  bool is_reference(int keyframe) const {
    return is_reference_[static_cast<size_t>(keyframe)] != 0;
  }
  /// Whether the pair a < b counts.
  bool is_compared(int a, int b) const;
  /// Keyframes begin..end-1, all arcs of which to earlier keyframes are known, cease to be
  /// references where enough of those before `begin` overlap them by half or more.
  /// `arcs`: their arcs, a < b.
  void thin(int begin, int end, std::span<const graph::Arc> arcs);
  /// One flag a keyframe.
  std::vector<char> take() && { return std::move(is_reference_); }

 private:
  std::vector<char> is_reference_;
};

}  // namespace hmt::submap
