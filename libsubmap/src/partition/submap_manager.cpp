// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/partition/submap_manager.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace hmt::submap {
namespace {

size_t at(int i) {
  return static_cast<size_t>(i);
}

bool contains(const std::vector<int>& sorted, int value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

}  // namespace

SubmapManager::SubmapManager(Space space, const SubmapPartitionOptions& options,
                             const OverlapOptions& overlap)
    : space_(space), options_(options), overlap_(overlap) {
  if (!(options.tau > 0 && options.tau < 2))
    throw InputError("tau is " + std::to_string(options.tau) + "; it must be above 0 and below 2");
  if (options.min_keyframes < 1)
    throw InputError("min_keyframes is " + std::to_string(options.min_keyframes) +
                     "; it must be >= 1");
  if (options.max_window < 2)
    throw InputError("max_window is " + std::to_string(options.max_window) + "; it must be >= 2");
}

std::vector<AreaEvent> SubmapManager::add(const Observation& observation,
                                          const Pose& T_world_keyframe,
                                          const PairCovariance& covariance,
                                          std::span<const Constraint> constraints) {
  const auto keyframe = static_cast<int>(areas_.size());
  if (!T_world_keyframe.translation.allFinite() || !T_world_keyframe.rotation.coeffs().allFinite())
    throw InputError("the pose of keyframe " + std::to_string(keyframe) + " is not finite");
  std::vector<WindowArc> row;
  for (size_t i = 0; i < window_.size(); ++i) {
    const auto known = covariance(window_[i], keyframe);
    if (!known) continue;
    const Pose T_a_b = graph::relative_pose(seen_[i].T_world_keyframe, T_world_keyframe);
    const double overlap =
        observation_overlap(seen_[i].observation, observation, T_a_b, *known, overlap_);
    if (overlap > 0 && overlap >= overlap_.min_overlap) row.push_back({window_[i], overlap});
  }
  return step(row, constraints, {observation, T_world_keyframe});
}

std::vector<AreaEvent> SubmapManager::add_row(std::span<const WindowArc> row,
                                              std::span<const Constraint> constraints) {
  return step(row, constraints, {});
}

std::vector<AreaEvent> SubmapManager::step(std::span<const WindowArc> row,
                                           std::span<const Constraint> constraints, Seen seen) {
  check(row, constraints);
  const auto keyframe = static_cast<int>(areas_.size());
  for (const WindowArc& arc : row)
    if (contains(window_, arc.keyframe)) arcs_.push_back({arc.keyframe, keyframe, arc.overlap});
  for (const Constraint& c : constraints)
    if (contains(window_, c.a)) constraints_.push_back(c);
  window_.push_back(keyframe);
  seen_.push_back(std::move(seen));
  areas_.push_back(-1);
  name_areas(partition_window());

  std::vector<AreaEvent> events;
  if (areas_.back() != current_) {
    current_ = areas_.back();
    events.push_back({AreaEvent::Kind::entered, current_, keyframes_of(current_)});
  }
  for (const int area : finished_areas()) events.push_back(close(area));
  for (const int area : crowded_out()) events.push_back(close(area));
  return events;
}

void SubmapManager::check(std::span<const WindowArc> row,
                          std::span<const Constraint> constraints) const {
  const auto keyframe = static_cast<int>(areas_.size());
  const std::string name = "keyframe " + std::to_string(keyframe) + ": ";
  std::vector<int> seen;
  for (const WindowArc& arc : row) {
    const std::string other = std::to_string(arc.keyframe);
    if (arc.keyframe < 0 || arc.keyframe >= keyframe)
      throw InputError(name + "overlap with keyframe " + other + ", which is not before it");
    if (!std::isfinite(arc.overlap) || arc.overlap < 0)
      throw InputError(name + "the overlap with keyframe " + other + " is " +
                       std::to_string(arc.overlap) + "; it must be finite and >= 0");
    seen.push_back(arc.keyframe);
  }
  std::sort(seen.begin(), seen.end());
  if (const auto twice = std::adjacent_find(seen.begin(), seen.end()); twice != seen.end())
    throw InputError(name + "two overlaps with keyframe " + std::to_string(*twice));
  for (const Constraint& c : constraints)
    if (c.b != keyframe || c.a < 0 || c.a >= keyframe || !c.information.allFinite())
      throw InputError(name + "a constraint between keyframes " + std::to_string(c.a) + " and " +
                       std::to_string(c.b) +
                       "; it must be of an earlier one with this one, and finite");
}

int SubmapManager::position(int keyframe) const {
  return static_cast<int>(std::lower_bound(window_.begin(), window_.end(), keyframe) -
                          window_.begin());
}

graph::WeightedGraph SubmapManager::window_overlap() const {
  std::vector<graph::Arc> arcs = arcs_;
  for (graph::Arc& arc : arcs) arc = {position(arc.a), position(arc.b), arc.weight};
  return {static_cast<int>(window_.size()), arcs};
}

graph::Labels SubmapManager::partition_window() const {
  std::vector<Constraint> constraints = constraints_;
  for (Constraint& c : constraints) {
    c.a = position(c.a);
    c.b = position(c.b);
  }
  return partition_keyframes(space_, window_overlap(), constraints, {}, options_, 1);
}

/// Gives each group the number of the area that most of its keyframes were in, each number once and
/// the largest share first; other groups are new areas.
void SubmapManager::name_areas(const graph::Labels& groups) {
  std::map<std::pair<int, int>, int> shares;  // keyframes by area and group
  for (size_t i = 0; i < groups.size(); ++i)
    if (const int area = areas_[at(window_[i])]; area >= 0) ++shares[{area, groups[i]}];
  std::vector<std::pair<std::pair<int, int>, int>> by_share(shares.begin(), shares.end());
  std::stable_sort(by_share.begin(), by_share.end(),
                   [](const auto& l, const auto& r) { return l.second > r.second; });
  const int count = groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end()) + 1;
  std::vector<int> number(at(count), -1);
  std::vector<int> taken;
  for (const auto& [share, keyframes] : by_share) {
    const auto [area, group] = share;
    if (number[at(group)] >= 0 || std::find(taken.begin(), taken.end(), area) != taken.end())
      continue;
    number[at(group)] = area;
    taken.push_back(area);
  }
  for (int& area : number) {
    if (area >= 0) continue;
    area = free_number(taken);
    taken.push_back(area);
  }
  if (const auto largest = std::max_element(number.begin(), number.end());
      largest != number.end() && at(*largest) >= is_closed_.size())
    is_closed_.resize(at(*largest) + 1, 0);
  for (size_t i = 0; i < groups.size(); ++i) areas_[at(window_[i])] = number[at(groups[i])];
}

int SubmapManager::free_number(const std::vector<int>& taken) const {
  auto area = static_cast<int>(is_closed_.size());
  // Looks back over the open numbers at the end only: no search that grows with the log.
  while (area > 0 && is_closed_[at(area - 1)] == 0) --area;
  while ((at(area) < is_closed_.size() && is_closed_[at(area)] != 0) ||
         std::find(taken.begin(), taken.end(), area) != taken.end())
    ++area;
  return area;
}

std::vector<int> SubmapManager::keyframes_of(int area) const {
  std::vector<int> keyframes;
  std::copy_if(window_.begin(), window_.end(), std::back_inserter(keyframes),
               [&](int keyframe) { return areas_[at(keyframe)] == area; });
  return keyframes;
}

/// Areas of the window that do not overlap the one that the robot is in, once that one has enough
/// keyframes to stay.
std::vector<int> SubmapManager::finished_areas() const {
  if (std::ssize(keyframes_of(current_)) < options_.min_keyframes) return {};
  std::vector<int> beside = {current_};
  for (const graph::Arc& arc : arcs_) {
    const int a = areas_[at(arc.a)];
    const int b = areas_[at(arc.b)];
    if (a == current_) beside.push_back(b);
    if (b == current_) beside.push_back(a);
  }
  std::sort(beside.begin(), beside.end());
  std::vector<int> finished;
  for (const int keyframe : window_)
    if (!contains(beside, areas_[at(keyframe)])) finished.push_back(areas_[at(keyframe)]);
  std::sort(finished.begin(), finished.end());
  finished.erase(std::unique(finished.begin(), finished.end()), finished.end());
  return finished;
}

/// Areas to close so that the window has room for one more keyframe, the longest unseen first.
std::vector<int> SubmapManager::crowded_out() const {
  std::map<int, std::pair<int, int>> areas;  // last keyframe and number of keyframes
  for (const int keyframe : window_) {
    auto& [last, count] = areas[areas_[at(keyframe)]];
    last = keyframe;
    ++count;
  }
  std::map<int, int> by_last;
  for (const auto& [area, extent] : areas) by_last[extent.first] = area;
  std::vector<int> closed;
  auto left = static_cast<int>(window_.size());
  for (const auto& [last, area] : by_last) {
    if (left < options_.max_window) break;
    closed.push_back(area);
    left -= areas[area].second;
  }
  return closed;
}

AreaEvent SubmapManager::close(int area) {
  AreaEvent event{AreaEvent::Kind::closed, area, keyframes_of(area)};
  const auto leaves = [&](int keyframe) { return areas_[at(keyframe)] == area; };
  size_t kept = 0;
  for (size_t i = 0; i < window_.size(); ++i) {
    if (leaves(window_[i])) continue;
    window_[kept] = window_[i];
    if (kept != i) seen_[kept] = std::move(seen_[i]);
    ++kept;
  }
  window_.resize(kept);
  seen_.resize(kept);
  std::erase_if(arcs_, [&](const graph::Arc& arc) { return leaves(arc.a) || leaves(arc.b); });
  std::erase_if(constraints_, [&](const Constraint& c) { return leaves(c.a) || leaves(c.b); });
  is_closed_[at(area)] = 1;
  if (area == current_) current_ = -1;
  return event;
}

std::vector<AreaEvent> SubmapManager::finish() {
  std::vector<int> open;
  for (const int keyframe : window_) open.push_back(areas_[at(keyframe)]);
  std::sort(open.begin(), open.end());
  open.erase(std::unique(open.begin(), open.end()), open.end());
  std::vector<AreaEvent> events;
  for (const int area : open) events.push_back(close(area));
  return events;
}

graph::Labels partition_in_sequence(
    Space space, const graph::WeightedGraph& overlap, std::span<const Constraint> constraints,
    const SubmapPartitionOptions& options,
    const std::function<void(int keyframe, const AreaEvent&)>& report) {
  std::vector<std::vector<Constraint>> with_earlier(at(overlap.num_nodes()));
  for (const Constraint& c : constraints) with_earlier.at(at(c.b)).push_back(c);
  SubmapManager manager(space, options);
  for (int keyframe = 0; keyframe < overlap.num_nodes(); ++keyframe) {
    std::vector<WindowArc> row;
    for (const auto& [other, weight] : overlap.neighbors(keyframe))
      if (other < keyframe) row.push_back({other, weight});
    for (const AreaEvent& event : manager.add_row(row, with_earlier[at(keyframe)]))
      report(keyframe, event);
  }
  for (const AreaEvent& event : manager.finish()) report(overlap.num_nodes() - 1, event);
  return graph::canonical_labels(manager.areas());
}

}  // namespace hmt::submap
