// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>
#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// A spanning forest of the edges of least `doubt` (Kruskal; ties by index).
std::vector<bool> least_doubted_forest(const PoseGraph& graph, const std::vector<double>& doubt);

/// The accepted edges of a graph, and which of them one mistake would explain.
///
/// Edges that run beside each other as the rungs of a ladder do, with their ends equally few
/// trusted edges apart on both sides, are one mistake if they are false: two places taken for one
/// along a stretch of the drive.
class AcceptedGraph {
 public:
  AcceptedGraph(const PoseGraph& graph, const std::vector<bool>& accepted,
                const std::vector<bool>& trusted);

  /// Whether edges k and l, accepted or not, run beside each other.
  bool are_beside(size_t k, size_t l) const;

  /// Piece of every node, numbered by smallest node: parts that no single mistake holds together.
  /// An edge stands between pieces if its ends come apart without it and the edges beside it;
  /// trusted edges never do.
  std::vector<int> pieces() const;

 private:
  struct Arc {
    int node;
    size_t edge;
  };
  using Steps = std::vector<std::pair<int, int>>;
  /// Nodes within kBeside trusted edges, and how many; sorted by node.
  Steps steps_from(int node) const;
  /// Accepted edges beside edge k, k included; ascending.
  std::vector<size_t> beside(size_t k) const;
  /// Whether the ends of edge k hold together without the given edges.
  bool holds_without(size_t k, const std::vector<size_t>& removed) const;

  const PoseGraph& graph_;
  const std::vector<bool>& accepted_;
  const std::vector<bool>& trusted_;
  std::vector<std::vector<Arc>> arcs_;
};

}  // namespace hmt::graph
