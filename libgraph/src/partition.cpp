// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/partition.hpp"

#include <tbb/info.h>
#include <tbb/parallel_for_each.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "best_first.hpp"
#include "bisection.hpp"
#include "hmt/graph/input_error.hpp"
#include "piece_peeling.hpp"

namespace hmt::graph {
namespace {

void check_options(const WeightedGraph& graph, const PartitionOptions& options, int threads) {
  if (!(options.tau > 0 && options.tau < 2))
    throw InputError("tau is " + std::to_string(options.tau) + "; it must be above 0 and below 2");
  if (options.min_size < 1)
    throw InputError("min_size is " + std::to_string(options.min_size) + "; it must be >= 1");
  if (threads < 1) throw InputError("threads is " + std::to_string(threads) + "; it must be >= 1");
  if (!options.groups) return;
  const int least = graph.num_nodes() == 0 ? 0 : 1;
  if (*options.groups < least || *options.groups > graph.num_nodes())
    throw InputError("groups is " + std::to_string(*options.groups) + "; a graph of " +
                     std::to_string(graph.num_nodes()) + " nodes has " + std::to_string(least) +
                     " to " + std::to_string(graph.num_nodes()));
}

// A bisection loses a crumb if one side has less than a thirty-second of the nodes. A group that
// has come out of so many of them in a row loses its crumbs in one pass from then on (peel_pieces),
// or the recursion would be as deep as a star has leaves.
constexpr int kCrumb = 32;
constexpr int kCrumbsInARow = 8;

// One group of the recursion tree. A group that was cut has parts and no graph.
struct Group {
  CsrGraph graph;
  int crumbs = 0;  // lost in a row by the bisections that led to this group
  std::vector<Group*> parts;
  std::vector<Bisection> bisections;
};

// Components leave one after the other: each is one bisection at Ncut 0.
std::vector<Bisection> report_components(const std::vector<CsrGraph>& parts) {
  std::vector<Bisection> all;
  int rest = 0;
  for (const CsrGraph& part : parts) rest += part.size();
  for (size_t k = 0; k + 1 < parts.size(); ++k) {
    rest -= parts[k].size();
    all.push_back({parts[k].size(), rest, 0, 0, 0});
  }
  return all;
}

// The recursion of Table 1. Groups are cut independently of each other, so their order is free; the
// tree keeps the result in the order of the recursion.
class Recursion {
 public:
  explicit Recursion(const PartitionOptions& options) : options_(options) {}

  void run(CsrGraph whole, int threads) {
    root_ = add(std::move(whole));
    tbb::task_arena arena(std::min(threads, tbb::info::default_concurrency()));
    arena.execute([&] {
      const std::vector<Group*> first = {root_};
      tbb::parallel_for_each(first.begin(), first.end(),
                             [&](Group* group, tbb::feeder<Group*>& feeder) {
                               cut(*group);
                               for (Group* part : group->parts) feeder.add(part);
                             });
    });
  }

  // Depth first, by an explicit stack: a hostile graph can make the tree as deep as it has nodes.
  PartitionResult result(int num_nodes) const {
    PartitionResult result;
    result.labels.assign(static_cast<size_t>(num_nodes), 0);
    std::vector<const Group*> stack = {root_};
    int label = 0;
    while (!stack.empty()) {
      const Group* group = stack.back();
      stack.pop_back();
      result.bisections.insert(result.bisections.end(), group->bisections.begin(),
                               group->bisections.end());
      for (const int node : group->graph.nodes) result.labels[static_cast<size_t>(node)] = label;
      if (group->parts.empty()) ++label;
      stack.insert(stack.end(), group->parts.rbegin(), group->parts.rend());
    }
    result.labels = canonical_labels(result.labels);
    return result;
  }

 private:
  Group* add(CsrGraph graph, int crumbs = 0) {
    const std::lock_guard lock(mutex_);
    groups_.push_back({std::move(graph), crumbs, {}, {}});
    return &groups_.back();
  }

  void replace(Group& group, std::vector<CsrGraph> parts) {
    const int size = group.graph.size();
    group.graph = {};
    for (CsrGraph& part : parts) {
      const bool lost_a_crumb = kCrumb * (size - part.size()) < size;
      const int crumbs = lost_a_crumb ? group.crumbs + 1 : 0;
      group.parts.push_back(add(std::move(part), crumbs));
    }
  }

  void cut(Group& group) {
    int components = 0;
    const std::vector<int> component = connected_components(group.graph, &components);
    if (components > 1) {
      auto parts = split(group.graph, component, components);
      group.bisections = report_components(parts);
      return replace(group, std::move(parts));
    }
    if (group.graph.size() >= std::max(2, options_.min_size)) {
      if (const auto cut = spectral_cut(group.graph, options_, options_.tau)) {
        return group.crumbs < kCrumbsInARow ? cut_in_two(group, *cut) : peel(group, *cut);
      }
    }
    keep_nodes_only(group.graph);
  }

  void cut_in_two(Group& group, const SpectralCut& cut) {
    group.bisections = {report(cut)};
    replace(group, split(group.graph, {cut.sides.begin(), cut.sides.end()}, 2));
  }

  void peel(Group& group, const SpectralCut& cut) {
    const Bisection first = report(cut);
    if (kCrumb * std::min(first.size_a, first.size_b) >= group.graph.size())
      return cut_in_two(group, cut);
    Peeling peeling = peel_pieces(group.graph, cut, options_.tau);
    auto parts = split(group.graph, peeling.part, peeling.parts);
    group.bisections = std::move(peeling.bisections);
    replace(group, std::move(parts));
    group.parts.front()->crumbs = group.crumbs;  // though half of the group may be gone
  }

  static void keep_nodes_only(CsrGraph& graph) {
    CsrGraph nodes_only;
    nodes_only.nodes = std::move(graph.nodes);
    graph = std::move(nodes_only);
  }

  const PartitionOptions& options_;
  std::mutex mutex_;
  std::deque<Group> groups_;
  Group* root_ = nullptr;
};

}  // namespace

Labels canonical_labels(const Labels& labels) {
  std::map<int, int> numbers;
  Labels result;
  result.reserve(labels.size());
  for (const int label : labels)
    result.push_back(numbers.emplace(label, static_cast<int>(numbers.size())).first->second);
  return result;
}

PartitionResult recursive_partition(const WeightedGraph& graph, const PartitionOptions& options,
                                    int threads) {
  check_options(graph, options, threads);
  if (graph.num_nodes() == 0) return {};
  if (options.groups) return best_first_partition(graph, options, threads);
  Recursion recursion(options);
  recursion.run(whole_graph(graph), threads);
  return recursion.result(graph.num_nodes());
}

}  // namespace hmt::graph
