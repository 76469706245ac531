// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "floor_plan.hpp"

#include <algorithm>
#include <utility>

namespace hmt::submap {
namespace {

/// Boxes closer than this touch.
constexpr double kTouching = 1e-6;  // metres

using Interval = std::pair<double, double>;

/// What is left of `whole` without the intervals of `holes`.
std::vector<Interval> without(Interval whole, std::vector<Interval> holes) {
  std::ranges::sort(holes);
  std::vector<Interval> rest;
  double from = whole.first;
  for (const auto& [begin, end] : holes) {
    if (begin > from) rest.emplace_back(from, std::min(begin, whole.second));
    from = std::max(from, end);
    if (from >= whole.second) return rest;
  }
  rest.emplace_back(from, whole.second);
  return rest;
}

/// Adds the parts of one side of box `own` behind which no free box lies. The side is at its lower
/// or upper end along `axis`.
void add_side(const std::vector<Box>& free, size_t own, int axis, bool upper,
              std::vector<Wall>& out) {
  const Box& box = free[own];
  const int along = 1 - axis;
  const double place = upper ? box.max()[axis] : box.min()[axis];
  std::vector<Interval> holes;
  for (size_t i = 0; i < free.size(); ++i) {
    const double low = free[i].min()[axis];
    const double high = free[i].max()[axis];
    const bool behind = upper ? low < place + kTouching && high > place + kTouching
                              : low < place - kTouching && high > place - kTouching;
    const Interval span(std::max(free[i].min()[along], box.min()[along]),
                        std::min(free[i].max()[along], box.max()[along]));
    if (i != own && behind && span.first < span.second) holes.push_back(span);
  }
  for (const auto& [from, to] : without({box.min()[along], box.max()[along]}, std::move(holes))) {
    Wall wall;
    wall.from[axis] = wall.to[axis] = place;
    wall.from[along] = from;
    wall.to[along] = to;
    out.push_back(wall);
  }
}

}  // namespace

std::vector<Wall> walls(const FloorPlan& plan) {
  std::vector<Wall> out;
  for (size_t i = 0; i < plan.free.size(); ++i)
    for (const int axis : {0, 1})
      for (const bool upper : {false, true}) add_side(plan.free, i, axis, upper, out);
  for (const Box& box : plan.furniture)
    for (const int axis : {0, 1})
      for (const bool upper : {false, true}) add_side({box}, 0, axis, upper, out);
  return out;
}

}  // namespace hmt::submap
