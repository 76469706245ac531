// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>
#include <utility>

#include "hmt/graph/partition.hpp"
#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// What a partition of a pose graph's nodes costs: the share of its information that lies between
/// different groups.
struct InformationLoss {
  /// e of Eq. 22, in [0, 1]; 0 for a graph without edges.
  double total = 0;
  /// The same for each pair of groups (a < b) that edges join; they sum up to `total`.
  std::map<std::pair<int, int>, double> between;
};

/// Information loss ratio [Blanco 2009, Eq. 22] of the Gauss-Newton information matrix H of the
/// graph at its poses: e = (sum of |H_ij| with i and j in different groups) / (sum of |H_ij| over
/// all i and j), |.| the Frobenius norm of the block of two poses. Parallel edges are summed into
/// their block first. Throws InputError if there is not one label a node.
InformationLoss information_loss(const PoseGraph& graph, std::span<const int> labels);

}  // namespace hmt::graph
