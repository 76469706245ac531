// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "references.hpp"

namespace hmt::submap {
namespace {

/// Keyframes this close in the log belong to one visit: a room with its corners takes as many.
constexpr int kSameVisit = 100;
/// A reference that overlaps a keyframe by half shows most of what can be registered. So many are
/// about two visits in the same direction at the usual half metre a keyframe.
constexpr double kLikeness = 0.5;
constexpr int kEnough = 16;

bool is_same_visit(int a, int b) {
  return b - a <= kSameVisit;
}

}  // namespace

bool References::is_compared(int a, int b) const {
  return is_reference(a) || is_same_visit(a, b);
}

void References::thin(int begin, int end, std::span<const graph::Arc> arcs) {
  std::vector<int> alike(static_cast<size_t>(end - begin), 0);
  for (const graph::Arc& arc : arcs)
    if (arc.a < begin && arc.weight >= kLikeness && is_reference(arc.a) &&
        !is_same_visit(arc.a, arc.b))
      ++alike[static_cast<size_t>(arc.b - begin)];
  for (int k = begin; k < end; ++k)
    if (alike[static_cast<size_t>(k - begin)] >= kEnough)
      is_reference_[static_cast<size_t>(k)] = char{0};
}

}  // namespace hmt::submap
