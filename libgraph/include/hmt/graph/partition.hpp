// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "hmt/graph/weighted_graph.hpp"

namespace hmt::graph {

/// Group of each node, numbered canonically: groups are 0..k-1 in the order of their smallest node.
using Labels = std::vector<int>;

/// Where the Fiedler vector is cut [Blanco 2009, Sec. 2.2].
enum class Threshold { mean, sign, sweep };

struct PartitionOptions {
  /// Accept a bisection if its Ncut < tau, 0 < tau < 2 [Blanco 2009, Table 1]; raising it gives
  /// more, smaller groups.
  double tau = 2.0 / 3.0;
  Threshold threshold = Threshold::sweep;
  /// Groups below this number of nodes are not cut, >= 1.
  int min_size = 1;
  /// Exactly this number of groups, best cut first, then refined together (refine_groups); 1 to the
  /// number of nodes. tau is not used then.
  std::optional<int> groups;
  /// Move nodes across each cut where that lowers its Ncut, and try other thresholds and the next
  /// eigenvectors before a group is declared whole. Off: the paper's bare threshold.
  bool refine = true;
};

/// One accepted bisection (or split into components, ncut 0), in the order of the recursion.
struct Bisection {
  int size_a = 0;
  int size_b = 0;
  double ncut = 0;  ///< Eq. 1, in [0, 2]
  /// Second smallest eigenvalue of Eq. 10, a lower bound of ncut; 0 for components and for pieces
  /// that left a group in one pass with others of their kind.
  double lambda_2 = 0;
  double residual = 0;  ///< |L z - lambda z| of the normalized Laplacian
};

struct PartitionResult {
  Labels labels;
  std::vector<Bisection> bisections;
};

/// The same grouping with groups numbered 0..k-1 in the order of their smallest node.
Labels canonical_labels(const Labels& labels);

/// Recursive spectral min-Ncut partition [Blanco 2009, Table 1]: connected components first, then
/// bisections. Independent of the order of the nodes and of the number of threads. The empty graph
/// gives no labels. Throws InputError naming the option that is out of range.
PartitionResult recursive_partition(const WeightedGraph& graph, const PartitionOptions& options,
                                    int threads = 1);

}  // namespace hmt::graph
