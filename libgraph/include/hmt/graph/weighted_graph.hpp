// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace hmt::graph {

/// One undirected arc between two different nodes.
struct Arc {
  int a = 0;
  int b = 0;
  double weight = 0;  ///< >= 0
};

/// Undirected weighted graph G = <V, E, Omega> as the sparse symmetric matrix Omega with zero
/// diagonal [Blanco 2009, Sec. 2.1]. Neighbours are kept in increasing order of node, so every walk
/// is deterministic.
class WeightedGraph {
 public:
  struct Neighbor {
    int node = 0;
    double weight = 0;
  };

  /// Graph without nodes.
  WeightedGraph() = default;
  /// Builds Omega; each pair may be given once, in either order. Arcs of weight zero are dropped.
  /// Throws InputError naming the arc where a node is outside [0, num_nodes), a == b, the pair is
  /// repeated, or the weight is negative or not finite.
  WeightedGraph(int num_nodes, std::span<const Arc> arcs);

  int num_nodes() const { return static_cast<int>(offsets_.size()) - 1; }
  /// Number of undirected arcs.
  int64_t num_arcs() const { return static_cast<int64_t>(neighbors_.size()) / 2; }
  std::span<const Neighbor> neighbors(int node) const;
  /// d_i: the sum of the weights at the node.
  double degree(int node) const { return degrees_[static_cast<size_t>(node)]; }
  /// omega_ij, 0 where there is no arc; logarithmic in the number of neighbours.
  double weight(int a, int b) const;
  /// Every arc once with a < b, ordered by (a, b).
  std::vector<Arc> arcs() const;

 private:
  /// Orders each row, sums it and drops the zeros; throws where a pair is repeated.
  void sort_and_sum();

  std::vector<int64_t> offsets_{0};
  std::vector<Neighbor> neighbors_;
  std::vector<double> degrees_;
};

}  // namespace hmt::graph
