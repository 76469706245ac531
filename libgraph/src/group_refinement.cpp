// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/group_refinement.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "bisection.hpp"
#include "chain_refinement.hpp"
#include "cut_refinement.hpp"
#include "group_table.hpp"
#include "hmt/graph/normalized_cut.hpp"

namespace hmt::graph {
namespace {

// Each ends sooner in practice; they bound the time on large graphs.
constexpr int kMaxRounds = 20;
constexpr int kMaxExchanges = 200;
// Merging and cutting looks at all groups for every change, so it is left out beyond this number.
constexpr int kMaxExchangeGroups = 500;
// Gain below which a change is not worth its time, and may be rounding.
constexpr double kMinGain = 1e-9;

struct Split {
  Excerpt excerpt;
  Sides sides;
  double shares = 0;  // of both sides in the k-way Ncut
};

double shares_of(const Excerpt& excerpt, const Sides& sides) {
  const Cut between = measure_cut(excerpt.graph, sides);
  double cut_a = between.cut;
  double cut_b = between.cut;
  double assoc_a = between.assoc_a;
  double assoc_b = between.assoc_b;
  for (size_t i = 0; i < sides.size(); ++i) {
    (sides[i] == 0 ? cut_a : cut_b) += excerpt.outside[i];
    (sides[i] == 0 ? assoc_a : assoc_b) += excerpt.outside[i];
  }
  return (cut_a > 0 ? cut_a / assoc_a : 0) + (cut_b > 0 ? cut_b / assoc_b : 0);
}

class GroupRefinement {
 public:
  GroupRefinement(const WeightedGraph& graph, Labels labels, int min_size)
      : table_(graph, std::move(labels)), min_size_(min_size) {
    splits_.resize(static_cast<size_t>(table_.size()));
    versions_.resize(static_cast<size_t>(table_.size()), 0);
    for (int g = 0; g < table_.size(); ++g) changed_.insert(g);
  }

  Labels run() {
    move_nodes();
    if (table_.size() > kMaxExchangeGroups) return table_.labels();
    for (int k = 0; k < kMaxExchanges && (exchange() || cut_a_pair_anew()); ++k) move_nodes();
    return table_.labels();
  }

 private:
  int version(int group) const { return versions_[static_cast<size_t>(group)]; }

  // Moves nodes between neighbors, strongest link first, until no pair gains.
  void move_nodes() {
    for (int round = 0; round < kMaxRounds && !changed_.empty(); ++round) {
      std::vector<std::tuple<double, int, int>> pairs;
      for (const int a : changed_)
        for (const auto& [b, weight] : table_[a].links)
          if (a < b || !changed_.contains(b))
            pairs.emplace_back(-weight, std::min(a, b), std::max(a, b));
      std::sort(pairs.begin(), pairs.end());
      changed_.clear();
      for (const auto& [weight, a, b] : pairs) move_between(a, b);
    }
    changed_.clear();
  }

  void move_between(int a, int b) {
    const Excerpt pair = table_.excerpt({a, b});
    Sides sides;
    for (const int node : pair.graph.nodes)
      sides.push_back(table_.labels()[static_cast<size_t>(node)] == a ? 0 : 1);
    if (refine_cut(pair.graph, sides, pair.outside) > kMinGain) assign(pair.graph, sides, a, b);
  }

  void assign(const CsrGraph& graph, const Sides& sides, int a, int b) {
    table_.assign(graph, sides, a, b);
    touch(a);
    touch(b);
  }

  void touch(int group) {
    changed_.insert(group);
    ++versions_[static_cast<size_t>(group)];
    splits_[static_cast<size_t>(group)].reset();
  }

  // The best way to cut some groups, taken together, into two; nothing if they must not be cut.
  std::optional<Split> best_split(const std::vector<int>& groups) {
    Split split{table_.excerpt(groups), {}, 0};
    const CsrGraph& graph = split.excerpt.graph;
    if (graph.size() < std::max(2, min_size_)) return std::nullopt;
    int components = 0;
    connected_components(graph, &components);
    if (components > 1) return std::nullopt;
    auto cut = spectral_cut(graph, {}, std::nullopt);
    if (!cut) return std::nullopt;
    split.sides = std::move(cut->sides);
    refine_cut(graph, split.sides, split.excerpt.outside);
    split.shares = shares_of(split.excerpt, split.sides);
    return split;
  }

  // Rise of the k-way Ncut when the group is cut; computed once until the group changes.
  double split_cost(int group) {
    auto& known = splits_[static_cast<size_t>(group)];
    if (!known) known = best_split({group});
    if (!*known) return std::numeric_limits<double>::infinity();
    return (*known)->shares - table_[group].share();
  }

  double merge_cost(int a, int b, double link) const {
    const auto& ga = table_[a];
    const auto& gb = table_[b];
    const double cut = std::max(0.0, ga.cut + gb.cut - 2 * link);
    return cut / (ga.assoc + gb.assoc) - ga.share() - gb.share();
  }

  // Merges two neighbors and cuts a third group where both together lower the sum most.
  bool exchange() {
    using Choice = std::tuple<double, int, int>;  // cost, groups
    std::vector<Choice> cuts;
    std::vector<Choice> merges;
    for (int g = 0; g < table_.size(); ++g) {
      cuts.emplace_back(split_cost(g), g, g);
      for (const auto& [other, weight] : table_[g].links)
        if (g < other) merges.emplace_back(merge_cost(g, other, weight), g, other);
    }
    std::sort(cuts.begin(), cuts.end());
    // A merge shares a group with at most two of the three cheapest cuts.
    cuts.resize(std::min<size_t>(cuts.size(), 3));
    std::tuple<double, int, int, int> best{-kMinGain, 0, 0, 0};
    for (const auto& [cost, a, b] : merges)
      for (const auto& [cut_cost, c, same] : cuts)
        if (c != a && c != b) best = std::min(best, {cost + cut_cost, a, b, c});
    const auto [cost, a, b, c] = best;
    if (cost >= -kMinGain) return false;
    const Split split = std::move(**splits_[static_cast<size_t>(c)]);
    table_.merge(a, b);
    touch(a);
    assign(split.excerpt.graph, split.sides, c, b);
    return true;
  }

  // Takes two neighbors together and cuts them in another way, where that pays; first pair found,
  // in the order of their share.
  bool cut_a_pair_anew() {
    std::vector<std::tuple<double, int, int>> pairs;
    for (int g = 0; g < table_.size(); ++g)
      for (const auto& [other, weight] : table_[g].links)
        if (g < other) pairs.emplace_back(-table_[g].share() - table_[other].share(), g, other);
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [minus_shares, a, b] : pairs) {
      const std::pair versions = {version(a), version(b)};
      const auto tried = tried_.find({a, b});
      if (tried != tried_.end() && tried->second == versions) continue;
      const auto split = best_split({a, b});
      if (split && split->shares < -minus_shares - kMinGain) {
        assign(split->excerpt.graph, split->sides, a, b);
        return true;
      }
      tried_[{a, b}] = versions;
    }
    return false;
  }

  GroupTable table_;
  int min_size_;
  std::set<int> changed_;  // groups whose pairs are to be looked at
  std::vector<std::optional<std::optional<Split>>> splits_;
  std::vector<int> versions_;                                 // grows when a group changes
  std::map<std::pair<int, int>, std::pair<int, int>> tried_;  // pairs not worth cutting anew
};

}  // namespace

Labels refine_groups(const WeightedGraph& graph, const Labels& labels, int min_size) {
  const double before = kway_ncut(graph, labels);
  const Labels given = canonical_labels(labels);
  Labels refined = GroupRefinement(graph, given, min_size).run();
  refine_by_chains(graph, refined);
  refined = canonical_labels(refined);
  return kway_ncut(graph, refined) < before ? refined : given;
}

}  // namespace hmt::graph
