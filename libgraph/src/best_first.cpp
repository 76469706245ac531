// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "best_first.hpp"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "bisection.hpp"
#include "coarsening.hpp"
#include "csr_graph.hpp"
#include "hmt/graph/group_refinement.hpp"
#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

/// Aggregates a group that are left to place the cuts between them.
constexpr int kLeastAggregates = 16;

struct Group {
  CsrGraph graph;
  std::optional<SpectralCut> cut;  // the best found; nothing for a group that must not be cut
};

// Whether `a` is cut before `b`: less Ncut, then more nodes, then the smaller node.
bool before(const Group& a, const Group& b) {
  if (a.cut.has_value() != b.cut.has_value()) return a.cut.has_value();
  if (!a.cut) return false;
  if (a.cut->ncut != b.cut->ncut) return a.cut->ncut < b.cut->ncut;
  if (a.graph.size() != b.graph.size()) return a.graph.size() > b.graph.size();
  return a.graph.nodes.front() < b.graph.nodes.front();
}

// Disconnected groups are cut between components, into sides of about equal numbers of nodes.
SpectralCut component_cut(const std::vector<int>& component, int components) {
  std::vector<size_t> size(static_cast<size_t>(components), 0);
  for (const int c : component) ++size[static_cast<size_t>(c)];
  int first_above = 1;
  size_t below = size.front();
  while (first_above + 1 < components &&
         2 * (below + size[static_cast<size_t>(first_above)]) <= component.size())
    below += size[static_cast<size_t>(first_above++)];
  SpectralCut cut;
  for (const int c : component) cut.sides.push_back(c < first_above ? 0 : 1);
  return cut;
}

std::optional<SpectralCut> best_cut(const CsrGraph& graph, const PartitionOptions& options) {
  if (graph.size() < std::max(2, options.min_size)) return std::nullopt;
  int components = 0;
  const std::vector<int> component = connected_components(graph, &components);
  if (components > 1) return component_cut(component, components);
  return spectral_cut(graph, options, std::nullopt);
}

class BestFirst {
 public:
  BestFirst(const PartitionOptions& options, int threads)
      : options_(options), arena_(std::min(threads, tbb::info::default_concurrency())) {}

  PartitionResult run(CsrGraph whole) {
    PartitionResult result;
    result.labels.assign(whole.nodes.size(), 0);
    groups_.push_back({std::move(whole), std::nullopt});
    find_cuts(0);
    while (static_cast<int>(groups_.size()) < *options_.groups)
      result.bisections.push_back(cut_best());
    for (size_t k = 0; k < groups_.size(); ++k)
      for (const int node : groups_[k].graph.nodes)
        result.labels[static_cast<size_t>(node)] = static_cast<int>(k);
    result.labels = canonical_labels(result.labels);
    return result;
  }

 private:
  void find_cuts(size_t first) {
    if (static_cast<int>(groups_.size()) == *options_.groups) return;
    arena_.execute([&] {
      tbb::parallel_for(first, groups_.size(),
                        [&](size_t k) { groups_[k].cut = best_cut(groups_[k].graph, options_); });
    });
  }

  Bisection cut_best() {
    const auto best = std::min_element(groups_.begin(), groups_.end(), before);
    if (!best->cut)
      throw InputError("groups is " + std::to_string(*options_.groups) + ", but only " +
                       std::to_string(groups_.size()) + " can be made with min_size " +
                       std::to_string(options_.min_size) + "; lower one of them");
    const Group chosen = std::move(*best);
    *best = std::move(groups_.back());
    groups_.pop_back();
    const size_t first = groups_.size();
    const Sides& sides = chosen.cut->sides;
    for (CsrGraph& part : split(chosen.graph, {sides.begin(), sides.end()}, 2))
      groups_.push_back({std::move(part), std::nullopt});
    find_cuts(first);
    return report(*chosen.cut);
  }

  const PartitionOptions& options_;
  tbb::task_arena arena_;
  std::vector<Group> groups_;
};

}  // namespace

PartitionResult best_first_partition(const WeightedGraph& graph, const PartitionOptions& options,
                                     int threads) {
  PartitionResult result = BestFirst(options, threads).run(whole_graph(graph));
  if (options.refine) result.labels = refine_groups(graph, result.labels, options.min_size);
  return result;
}

Labels coarse_best_first_labels(const WeightedGraph& graph, int groups, int threads) {
  CsrGraph coarse = whole_graph(graph);
  std::vector<int> aggregate = coarse.nodes;
  while (coarse.size() >= 4 * kLeastAggregates * groups) {
    CoarseGraph next = coarsen(coarse);
    // Nodes without arcs are joined to none.
    if (2 * next.graph.size() > coarse.size()) break;
    for (int& a : aggregate) a = next.aggregate[static_cast<size_t>(a)];
    coarse = std::move(next.graph);
  }
  std::iota(coarse.nodes.begin(), coarse.nodes.end(), 0);
  PartitionOptions options;
  options.groups = groups;
  const Labels labels = BestFirst(options, threads).run(std::move(coarse)).labels;
  for (int& a : aggregate) a = labels[static_cast<size_t>(a)];
  return canonical_labels(aggregate);
}

}  // namespace hmt::graph
