// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/weighted_graph.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

[[noreturn]] void refuse(const Arc& arc, size_t index, const std::string& reason) {
  std::ostringstream text;
  text.precision(17);
  text << "arc " << index << " (row " << arc.a << ", column " << arc.b << ", weight " << arc.weight
       << "): " << reason;
  throw InputError(text.str());
}

void check_arc(const Arc& arc, size_t index, int num_nodes) {
  const auto outside = [num_nodes](int node) { return node < 0 || node >= num_nodes; };
  if (outside(arc.a) || outside(arc.b))
    refuse(arc, index, "nodes must be in [0, " + std::to_string(num_nodes) + ")");
  if (arc.a == arc.b) refuse(arc, index, "an arc must join two different nodes");
  if (!std::isfinite(arc.weight)) refuse(arc, index, "weights must be finite numbers");
  if (arc.weight < 0) refuse(arc, index, "weights must not be negative");
}

}  // namespace

WeightedGraph::WeightedGraph(int num_nodes, std::span<const Arc> arcs) {
  if (num_nodes < 0)
    throw InputError("number of nodes is " + std::to_string(num_nodes) + "; it must be >= 0");
  for (size_t i = 0; i < arcs.size(); ++i) check_arc(arcs[i], i, num_nodes);

  const auto n = static_cast<size_t>(num_nodes);
  offsets_.assign(n + 1, 0);
  // Arcs of weight zero take part in the check for repetition and are dropped after it.
  for (const Arc& arc : arcs) {
    ++offsets_[static_cast<size_t>(arc.a) + 1];
    ++offsets_[static_cast<size_t>(arc.b) + 1];
  }
  for (size_t i = 0; i < n; ++i) offsets_[i + 1] += offsets_[i];
  neighbors_.resize(static_cast<size_t>(offsets_[n]));
  std::vector<int64_t> next(offsets_.begin(), offsets_.end() - 1);
  for (const Arc& arc : arcs) {
    neighbors_[static_cast<size_t>(next[static_cast<size_t>(arc.a)]++)] = {arc.b, arc.weight};
    neighbors_[static_cast<size_t>(next[static_cast<size_t>(arc.b)]++)] = {arc.a, arc.weight};
  }
  sort_and_sum();
}

void WeightedGraph::sort_and_sum() {
  const size_t n = offsets_.size() - 1;
  degrees_.assign(n, 0);
  size_t kept = 0;
  for (size_t i = 0; i < n; ++i) {
    const auto begin = neighbors_.begin() + offsets_[i];
    const auto end = neighbors_.begin() + offsets_[i + 1];
    offsets_[i] = static_cast<int64_t>(kept);
    std::sort(begin, end, [](const Neighbor& x, const Neighbor& y) { return x.node < y.node; });
    const auto twice = std::adjacent_find(
        begin, end, [](const Neighbor& x, const Neighbor& y) { return x.node == y.node; });
    if (twice != end)
      throw InputError("arc (row " + std::to_string(i) + ", column " + std::to_string(twice->node) +
                       ") is given twice; each pair may be given once");
    for (auto it = begin; it != end; ++it) {
      if (it->weight == 0) continue;
      degrees_[i] += it->weight;
      neighbors_[kept++] = *it;
    }
    if (!std::isfinite(degrees_[i]))
      throw InputError("the weights at node " + std::to_string(i) + " sum to infinity");
  }
  offsets_[n] = static_cast<int64_t>(kept);
  neighbors_.resize(kept);
}

std::span<const WeightedGraph::Neighbor> WeightedGraph::neighbors(int node) const {
  const auto i = static_cast<size_t>(node);
  return {neighbors_.data() + offsets_[i], neighbors_.data() + offsets_[i + 1]};
}

double WeightedGraph::weight(int a, int b) const {
  const auto row = neighbors(a);
  const auto it = std::lower_bound(row.begin(), row.end(), b,
                                   [](const Neighbor& n, int node) { return n.node < node; });
  return it != row.end() && it->node == b ? it->weight : 0;
}

std::vector<Arc> WeightedGraph::arcs() const {
  std::vector<Arc> all;
  all.reserve(static_cast<size_t>(num_arcs()));
  for (int a = 0; a < num_nodes(); ++a)
    for (const Neighbor& n : neighbors(a))
      if (a < n.node) all.push_back({a, n.node, n.weight});
  return all;
}

}  // namespace hmt::graph
