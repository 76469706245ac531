// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/graph/partition.hpp"
#include "hmt/graph/weighted_graph.hpp"

namespace hmt::graph {

/// cut(A, B), assoc(A, V) and assoc(B, V) of the two groups of a bisection, Eq. 2 and 3: ordered
/// pairs, so an inside arc counts twice in its assoc.
struct Cut {
  double cut = 0;
  double assoc_a = 0;
  double assoc_b = 0;
  /// Eq. 1; 0 where nothing is cut (also for an empty side).
  double ncut() const;
};

/// Cut between the nodes of group `a` and those of group `b`; nodes of other groups are left out of
/// the graph.
Cut cut_between(const WeightedGraph& graph, const Labels& labels, int a, int b);

/// Sum over groups of cut(A, V \ A) / assoc(A, V); a group without arcs counts 0. For two groups
/// this is Eq. 1.
double kway_ncut(const WeightedGraph& graph, const Labels& labels);

}  // namespace hmt::graph
