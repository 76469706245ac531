// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/partition/submap_partition.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
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

graph::Labels connected_pieces(const graph::Labels& groups,
                               std::span<const Constraint> constraints) {
  Components components(groups.size());
  for (const Constraint& c : constraints)
    if (groups[static_cast<size_t>(c.a)] == groups[static_cast<size_t>(c.b)])
      components.join(c.a, c.b);
  graph::Labels pieces(groups.size());
  for (size_t i = 0; i < groups.size(); ++i) pieces[i] = components.root(static_cast<int>(i));
  return graph::canonical_labels(pieces);
}

/// The group that shares most constraints with group `piece`; the piece itself if there is none.
int best_neighbor(const graph::Labels& labels, std::span<const Constraint> constraints, int piece) {
  std::map<int, int> shared;
  for (const Constraint& c : constraints) {
    const int a = labels[static_cast<size_t>(c.a)];
    const int b = labels[static_cast<size_t>(c.b)];
    if (a == piece && b != piece) ++shared[b];
    if (b == piece && a != piece) ++shared[a];
  }
  const auto best =
      std::max_element(shared.begin(), shared.end(),
                       [](const auto& l, const auto& r) { return l.second < r.second; });
  return best == shared.end() ? piece : best->first;
}

graph::Labels without_small_pieces(graph::Labels labels, std::span<const Constraint> constraints) {
  const int groups = labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end()) + 1;
  for (int piece = 0; piece < groups; ++piece) {
    if (std::count(labels.begin(), labels.end(), piece) >= kMinPiece) continue;
    const int target = best_neighbor(labels, constraints, piece);
    std::replace(labels.begin(), labels.end(), piece, target);
  }
  return graph::canonical_labels(labels);
}

}  // namespace

graph::Labels partition_keyframes(Space space, const graph::WeightedGraph& overlap,
                                  std::span<const Constraint> constraints,
                                  const SubmapPartitionOptions& options, int threads) {
  graph::PartitionOptions recursion;
  recursion.tau = options.tau;
  recursion.min_size = options.min_keyframes;
  const graph::Labels groups = graph::recursive_partition(overlap, recursion, threads).labels;
  std::vector<Constraint> firm;
  std::copy_if(constraints.begin(), constraints.end(), std::back_inserter(firm),
               [space](const Constraint& c) { return is_firm(c, space); });
  return without_small_pieces(connected_pieces(groups, firm), firm);
}

}  // namespace hmt::submap
