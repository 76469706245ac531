// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// Information loss ratio [Blanco 2009, Eq. 22] of the information matrix H of the points alone,
/// all poses marginalized out: H = H_ll - H_lp H_pp^-1 H_pl of the Gauss-Newton information at the
/// poses and points, gauge of PoseGraph::fixed. e = (sum of |H_ij| over points i and j without a
/// common group) / (sum of |H_ij| over all i and j), |.| the Frobenius norm of the block of two
/// points.
///
/// `groups_of_point`: the groups that a point belongs to, increasing; a point may belong to
/// several. Points that no edge measures are left out; 0 without points, and where the poses are
/// not held together. O(points * poses) time, O(poses) memory beside the factor. Throws InputError
/// if there is not one list of groups a point.
double point_information_loss(const PoseGraph& graph,
                              std::span<const std::vector<int>> groups_of_point);

/// The same for many partitions of one graph: keeps the norms of all blocks, O(points^2) memory.
class PointInformationBlocks {
 public:
  explicit PointInformationBlocks(const PoseGraph& graph);

  double loss(std::span<const std::vector<int>> groups_of_point) const;

 private:
  struct Block {
    size_t i = 0;
    size_t j = 0;
    double norm = 0;
  };
  size_t num_points_ = 0;
  std::vector<Block> blocks_;
};

}  // namespace hmt::graph
