// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "group_table.hpp"

#include <algorithm>
#include <utility>

namespace hmt::graph {

GroupTable::GroupTable(const WeightedGraph& graph, Labels labels)
    : graph_(graph), labels_(std::move(labels)), local_(labels_.size(), -1) {
  if (labels_.empty()) return;
  groups_.resize(static_cast<size_t>(*std::max_element(labels_.begin(), labels_.end())) + 1);
  for (size_t i = 0; i < labels_.size(); ++i)
    groups_[static_cast<size_t>(labels_[i])].nodes.push_back(static_cast<int>(i));
  for (int g = 0; g < size(); ++g) gather(g);
}

Excerpt GroupTable::excerpt(const std::vector<int>& groups) {
  Excerpt result;
  CsrGraph& part = result.graph;
  for (const int g : groups)
    part.nodes.insert(part.nodes.end(), (*this)[g].nodes.begin(), (*this)[g].nodes.end());
  std::sort(part.nodes.begin(), part.nodes.end());
  for (int i = 0; i < part.size(); ++i)
    local_[static_cast<size_t>(part.nodes[static_cast<size_t>(i)])] = i;
  for (const int node : part.nodes) {
    double inside = 0;
    double outside = 0;
    for (const auto& [other, weight] : graph_.neighbors(node)) {
      const int column = local_[static_cast<size_t>(other)];
      if (column < 0) {
        outside += weight;
        continue;
      }
      part.columns.push_back(column);
      part.weights.push_back(weight);
      inside += weight;
    }
    part.offsets.push_back(static_cast<int64_t>(part.columns.size()));
    part.degrees.push_back(inside);
    result.outside.push_back(outside);
  }
  for (const int node : part.nodes) local_[static_cast<size_t>(node)] = -1;
  return result;
}

void GroupTable::assign(const CsrGraph& graph, const Sides& sides, int a, int b) {
  groups_[static_cast<size_t>(a)].nodes.clear();
  groups_[static_cast<size_t>(b)].nodes.clear();
  for (size_t i = 0; i < sides.size(); ++i) {
    const int group = sides[i] == 0 ? a : b;
    labels_[static_cast<size_t>(graph.nodes[i])] = group;
    groups_[static_cast<size_t>(group)].nodes.push_back(graph.nodes[i]);
  }
  gather(a);
  gather(b);
}

void GroupTable::merge(int a, int b) {
  std::vector<int>& nodes = groups_[static_cast<size_t>(a)].nodes;
  std::vector<int>& given = groups_[static_cast<size_t>(b)].nodes;
  for (const int node : given) labels_[static_cast<size_t>(node)] = a;
  nodes.insert(nodes.end(), given.begin(), given.end());
  std::sort(nodes.begin(), nodes.end());
  given.clear();
  gather(a);
  gather(b);
}

void GroupTable::gather(int group) {
  Group& own = groups_[static_cast<size_t>(group)];
  for (const auto& [other, weight] : own.links)
    groups_[static_cast<size_t>(other)].links.erase(group);
  own.links.clear();
  own.cut = 0;
  own.assoc = 0;
  for (const int node : own.nodes)
    for (const auto& [other, weight] : graph_.neighbors(node)) {
      const int other_group = labels_[static_cast<size_t>(other)];
      own.assoc += weight;
      if (other_group == group) continue;
      own.cut += weight;
      own.links[other_group] += weight;
    }
  for (const auto& [other, weight] : own.links)
    groups_[static_cast<size_t>(other)].links[group] = weight;
}

}  // namespace hmt::graph
