// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "csr_graph.hpp"
#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// Some groups of a graph taken out of it, with what they lose.
struct Excerpt {
  CsrGraph graph;
  std::vector<double> outside;  ///< weight from each local node to nodes that are left out
};

/// Groups of a partition with their share of the k-way Ncut and the weights between them, kept up
/// to date while nodes change groups.
class GroupTable {
 public:
  struct Group {
    std::vector<int> nodes;  ///< ascending
    double cut = 0;
    double assoc = 0;
    std::map<int, double> links;  ///< weight to each neighboring group

    /// cut(A) / assoc(A), 0 for a group without arcs.
    double share() const { return cut > 0 ? cut / assoc : 0; }
  };

  /// `labels` are canonical.
  GroupTable(const WeightedGraph& graph, Labels labels);

  const Labels& labels() const { return labels_; }
  int size() const { return static_cast<int>(groups_.size()); }
  const Group& operator[](int group) const { return groups_[static_cast<size_t>(group)]; }

  /// The nodes of one group, or of two, with the arcs among them.
  Excerpt excerpt(const std::vector<int>& groups);

  /// Gives the nodes of `graph` with side 0 to group `a` and the others to group `b`.
  void assign(const CsrGraph& graph, const Sides& sides, int a, int b);
  /// Moves all nodes of group `b` to group `a`; `b` stays empty until it is assigned nodes.
  void merge(int a, int b);

 private:
  void gather(int group);

  const WeightedGraph& graph_;
  Labels labels_;
  std::vector<Group> groups_;
  std::vector<int> local_;  // scratch: number of a node in an excerpt, -1 outside
};

}  // namespace hmt::graph
