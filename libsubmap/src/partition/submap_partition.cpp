// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/partition/submap_partition.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace hmt::submap {
namespace {

// A submap of one or two keyframes says nothing that its neighbor could not say better.
constexpr int kMinPiece = 3;

/// Connected components by union-find; the root of a set is its smallest keyframe.
class Components {
 public:
  explicit Components(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }

  int root(int i) {
    while (at(i) != i) i = at(i) = at(at(i));
    return i;
  }
  void join(int i, int j) {
    const auto [low, high] = std::minmax({root(i), root(j)});
    at(high) = low;
  }

 private:
  int& at(int i) { return parent_[static_cast<size_t>(i)]; }
  std::vector<int> parent_;
};

/// Landmarks seen from each component.
std::map<int, std::set<int>> landmarks_of(Components& components,
                                          std::span<const Sighting> sightings) {
  std::map<int, std::set<int>> landmarks;
  for (const Sighting& s : sightings) landmarks[components.root(s.keyframe)].insert(s.landmark);
  return landmarks;
}

/// Joins components of one group that saw enough common landmarks, until none is left. A component
/// that grows sees more.
void join_by_landmarks(Components& components, const graph::Labels& groups,
                       std::span<const Sighting> sightings, size_t enough) {
  for (bool joined = true; joined;) {
    joined = false;
    std::map<std::pair<int, int>, std::vector<int>> seen_from;  // group and landmark
    for (const auto& [component, landmarks] : landmarks_of(components, sightings))
      for (const int landmark : landmarks)
        seen_from[{groups[static_cast<size_t>(component)], landmark}].push_back(component);
    std::map<std::pair<int, int>, size_t> common;
    for (const auto& [key, by] : seen_from)
      for (size_t i = 0; i < by.size(); ++i)
        for (size_t j = i + 1; j < by.size(); ++j) ++common[{by[i], by[j]}];
    for (const auto& [pair, count] : common)
      if (count >= enough && components.root(pair.first) != components.root(pair.second)) {
        components.join(pair.first, pair.second);
        joined = true;
      }
  }
}

graph::Labels connected_pieces(const graph::Labels& groups, std::span<const Constraint> constraints,
                               std::span<const Sighting> sightings, size_t enough) {
  Components components(groups.size());
  for (const Constraint& c : constraints)
    if (groups[static_cast<size_t>(c.a)] == groups[static_cast<size_t>(c.b)])
      components.join(c.a, c.b);
  join_by_landmarks(components, groups, sightings, enough);
  graph::Labels pieces(groups.size());
  for (size_t i = 0; i < groups.size(); ++i) pieces[i] = components.root(static_cast<int>(i));
  return graph::canonical_labels(pieces);
}

/// The pieces of a partition, with those too small to stand alone joined to others, in the time of
/// one walk over the constraints.
class Pieces {
 public:
  Pieces(const graph::Labels& labels, std::span<const Constraint> constraints)
      : count_(labels.empty() ? 0 : at(*std::max_element(labels.begin(), labels.end())) + 1),
        joined_to_(count_),
        keyframes_(count_, 0),
        tied_to_(count_) {
    std::iota(joined_to_.begin(), joined_to_.end(), 0);
    for (const int label : labels) ++keyframes_[at(label)];
    for (const Constraint& c : constraints) {
      const int a = labels[at(c.a)];
      const int b = labels[at(c.b)];
      if (a == b) continue;
      tied_to_[at(a)].push_back(b);
      tied_to_[at(b)].push_back(a);
    }
  }

  void join_small() {
    for (size_t piece = 0; piece < count_; ++piece) {
      if (keyframes_[piece] >= kMinPiece) continue;
      const int target = best_neighbor(static_cast<int>(piece));
      joined_to_[piece] = target;
      if (target == static_cast<int>(piece)) continue;
      keyframes_[at(target)] += keyframes_[piece];
      auto& ties = tied_to_[at(target)];
      ties.insert(ties.end(), tied_to_[piece].begin(), tied_to_[piece].end());
    }
  }

  /// The piece that `piece` is part of by now.
  int current(int piece) const {
    while (joined_to_[at(piece)] != piece) piece = joined_to_[at(piece)];
    return piece;
  }

 private:
  static size_t at(int i) { return static_cast<size_t>(i); }

  /// The piece that shares most constraints with `piece`; itself if there is none.
  int best_neighbor(int piece) const {
    std::map<int, int> shared;
    for (const int tied : tied_to_[at(piece)])
      if (const int other = current(tied); other != piece) ++shared[other];
    const auto best =
        std::max_element(shared.begin(), shared.end(),
                         [](const auto& l, const auto& r) { return l.second < r.second; });
    return best == shared.end() ? piece : best->first;
  }

  size_t count_;
  std::vector<int> joined_to_;
  std::vector<int> keyframes_;
  std::vector<std::vector<int>> tied_to_;  ///< for each constraint, the piece at its other end
};

graph::Labels without_small_pieces(graph::Labels labels, std::span<const Constraint> constraints) {
  Pieces pieces(labels, constraints);
  pieces.join_small();
  for (int& label : labels) label = pieces.current(label);
  return graph::canonical_labels(labels);
}

}  // namespace

graph::Labels partition_keyframes(Space space, const graph::WeightedGraph& overlap,
                                  std::span<const Constraint> constraints,
                                  std::span<const Sighting> sightings,
                                  const SubmapPartitionOptions& options, int threads) {
  graph::PartitionOptions recursion;
  recursion.tau = options.tau;
  recursion.min_size = options.min_keyframes;
  const graph::Labels groups = graph::recursive_partition(overlap, recursion, threads).labels;
  std::vector<Constraint> firm;
  std::copy_if(constraints.begin(), constraints.end(), std::back_inserter(firm),
               [space](const Constraint& c) { return is_firm(c, space); });
  const size_t enough = space == Space::se2 ? 2 : 3;
  return without_small_pieces(connected_pieces(groups, firm, sightings, enough), firm);
}

}  // namespace hmt::submap
