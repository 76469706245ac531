// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "chain_refinement.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace hmt::graph {
namespace {

// Rounds end sooner in practice: the first without a gain is the last.
constexpr int kMaxRounds = 10;
// Moves of one chain without a new minimum.
constexpr size_t kMaxStall = 25;
constexpr double kMinGain = 1e-9;

double share(double cut, double assoc) {
  return cut > 0 && assoc > 0 ? cut / assoc : 0;
}

struct Move {
  double delta = std::numeric_limits<double>::infinity();
  int node = -1;
  int to = -1;

  bool operator<(const Move& o) const {
    if (delta != o.delta) return delta < o.delta;
    return node != o.node ? node < o.node : to < o.to;
  }
};

class Chains {
 public:
  Chains(const WeightedGraph& graph, Labels& labels) : graph_(graph), labels_(labels) {
    const auto n = labels.size();
    const int groups = *std::max_element(labels.begin(), labels.end()) + 1;
    groups_.resize(static_cast<size_t>(groups));
    links_.resize(n);
    state_.assign(n, kFree);
    for (int v = 0; v < graph.num_nodes(); ++v) {
      Group& own = group_of(v);
      ++own.nodes;
      own.assoc += graph.degree(v);
      for (const auto& [other, weight] : graph.neighbors(v)) {
        add_link(v, label(other), weight);
        if (label(other) != label(v)) own.cut += weight;
      }
    }
  }

  bool run() {
    bool changed = false;
    std::vector<uint8_t> active(groups_.size(), 1);  // groups that the round before changed
    for (int round = 0; round < kMaxRounds; ++round) {
      const std::vector<Move> seeds = best_moves(active);
      active.assign(groups_.size(), 0);
      bool gained = false;
      for (const Move& seed : seeds) gained = chain(seed.node, active) || gained;
      if (!gained) break;
      changed = true;
    }
    return changed;
  }

 private:
  enum State : uint8_t { kFree, kCandidate, kMoved };
  struct Group {
    int nodes = 0;
    double cut = 0;
    double assoc = 0;
  };
  struct Link {
    int group = 0;
    int arcs = 0;  // the link goes when the last arc does, not when rounding says 0
    double weight = 0;
  };

  static bool is_set(const std::vector<uint8_t>& flags, int g) {
    return flags[static_cast<size_t>(g)] != 0;
  }
  int& label(int v) { return labels_[static_cast<size_t>(v)]; }
  State& state(int v) { return state_[static_cast<size_t>(v)]; }
  Group& group(int g) { return groups_[static_cast<size_t>(g)]; }
  Group& group_of(int v) { return group(label(v)); }

  void add_link(int v, int g, double weight) {
    auto& links = links_[static_cast<size_t>(v)];
    const auto it =
        std::find_if(links.begin(), links.end(), [g](const Link& l) { return l.group == g; });
    if (it == links.end())
      links.push_back({g, 1, weight});
    else {
      it->weight += weight;
      ++it->arcs;
    }
  }

  void drop_link(int v, int g, double weight) {
    auto& links = links_[static_cast<size_t>(v)];
    const auto it =
        std::find_if(links.begin(), links.end(), [g](const Link& l) { return l.group == g; });
    it->weight -= weight;
    if (--it->arcs == 0) links.erase(it);
  }

  double link(int v, int g) const {
    for (const Link& l : links_[static_cast<size_t>(v)])
      if (l.group == g) return l.weight;
    return 0;
  }

  // Change of the k-way Ncut if the node leaves its group for `to`.
  double delta(int v, int to, double to_link, double own_link) {
    const Group& a = group_of(v);
    const Group& b = group(to);
    const double d = graph_.degree(v);
    return share(a.cut + 2 * own_link - d, a.assoc - d) +
           share(b.cut + d - 2 * to_link, b.assoc + d) - share(a.cut, a.assoc) -
           share(b.cut, b.assoc);
  }

  // No node where the node cannot move: it has no other group beside it, or is the last of its own.
  Move best_move(int v) {
    Move best;
    const auto& links = links_[static_cast<size_t>(v)];
    if (group_of(v).nodes == 1) return best;
    const double own = link(v, label(v));
    for (const Link& l : links)
      if (l.group != label(v))
        best = std::min(best, Move{delta(v, l.group, l.weight, own), v, l.group});
    return best;
  }

  // The best move from every group to every neighboring group, best first; one of the two must be
  // active.
  std::vector<Move> best_moves(const std::vector<uint8_t>& active) {
    std::map<std::pair<int, int>, Move> best;
    for (int v = 0; v < graph_.num_nodes(); ++v) {
      if (group_of(v).nodes == 1) continue;
      const double own = link(v, label(v));
      for (const Link& l : links_[static_cast<size_t>(v)])
        if (l.group != label(v) && (is_set(active, l.group) || is_set(active, label(v)))) {
          Move& known = best[{label(v), l.group}];
          known = std::min(known, Move{delta(v, l.group, l.weight, own), v, l.group});
        }
    }
    std::vector<Move> moves;
    moves.reserve(best.size());
    for (const auto& [pair, move] : best) moves.push_back(move);
    std::sort(moves.begin(), moves.end());
    return moves;
  }

  void apply(int v, int to) {
    const int from = label(v);
    const double own = link(v, from);
    const double other = link(v, to);
    const double d = graph_.degree(v);
    group(from).cut += 2 * own - d;
    group(from).assoc -= d;
    --group(from).nodes;
    group(to).cut += d - 2 * other;
    group(to).assoc += d;
    ++group(to).nodes;
    label(v) = to;
    for (const auto& [u, weight] : graph_.neighbors(v)) {
      drop_link(u, from, weight);
      add_link(u, to, weight);
    }
  }

  void add_candidate(int v) {
    if (state(v) != kFree) return;
    state(v) = kCandidate;
    touched_.push_back(v);
  }

  Move best_candidate() {
    Move best;
    for (const int v : touched_)
      if (state(v) == kCandidate) best = std::min(best, best_move(v));
    return best;
  }

  // True if the chain lowered the objective; then the groups of its nodes become active. Otherwise
  // everything is as before.
  bool chain(int seed, std::vector<uint8_t>& active) {
    std::vector<std::pair<int, int>> moves;  // node, the group that it left
    double total = 0;
    double least = 0;
    size_t kept = 0;
    add_candidate(seed);
    while (moves.size() - kept < kMaxStall) {
      const Move move = best_candidate();
      if (move.node < 0) break;
      moves.emplace_back(move.node, label(move.node));
      apply(move.node, move.to);
      state(move.node) = kMoved;
      for (const auto& [u, weight] : graph_.neighbors(move.node))
        if (label(u) == moves.back().second || label(u) == move.to) add_candidate(u);
      total += move.delta;
      if (total < least - kMinGain) {
        least = total;
        kept = moves.size();
      }
    }
    for (; moves.size() > kept; moves.pop_back()) apply(moves.back().first, moves.back().second);
    for (const auto& [v, left] : moves)
      active[static_cast<size_t>(left)] = active[static_cast<size_t>(label(v))] = 1;
    for (const int v : touched_) state(v) = kFree;
    touched_.clear();
    return kept > 0;
  }

  const WeightedGraph& graph_;
  Labels& labels_;
  std::vector<Group> groups_;
  std::vector<std::vector<Link>> links_;  // of each node, to every group beside it
  std::vector<State> state_;
  std::vector<int> touched_;  // nodes whose state is not kFree
};

}  // namespace

bool refine_by_chains(const WeightedGraph& graph, Labels& labels) {
  return !labels.empty() && Chains(graph, labels).run();
}

}  // namespace hmt::graph
