// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "hmt/graph/partition.hpp"
#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// What a partition of a pose graph's nodes costs: the share of its information that lies between
/// different groups.
struct InformationLoss {
  /// e of Eq. 22, in [0, 1]; 0 for a graph without edges and sightings.
  double total = 0;
  /// The same for each pair of groups (a < b) that share any; they sum up to `total`.
  std::map<std::pair<int, int>, double> between;
};

/// The Gauss-Newton information matrix H of a pose graph at its poses, as the Frobenius norms
/// |H_ij| of the blocks of two poses, all points marginalized out: two poses that sighted the same
/// point share information as if an edge joined them. Parallel edges are summed into their block
/// first.
class InformationBlocks {
 public:
  explicit InformationBlocks(const PoseGraph& graph);

  /// Information loss ratio [Blanco 2009, Eq. 22]: e = (sum of |H_ij| with i and j in different
  /// groups) / (sum of |H_ij| over all i and j). Linear in the edges. Throws InputError if there is
  /// not one label a node.
  InformationLoss loss(std::span<const int> labels) const;

 private:
  struct Block {
    int i = 0;
    int j = 0;        ///< > i
    double norm = 0;  ///< |H_ij| + |H_ji|
  };
  size_t num_nodes_ = 0;
  std::vector<Block> off_diagonal_;  ///< ordered by (i, j)
  double all_ = 0;                   ///< sum of |H_ij| over all i and j
};

/// The same for one partition.
InformationLoss information_loss(const PoseGraph& graph, std::span<const int> labels);

}  // namespace hmt::graph
