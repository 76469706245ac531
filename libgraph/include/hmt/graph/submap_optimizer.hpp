// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/graph/pose_optimizer.hpp"

namespace hmt::graph {

/// Sizes and times of an optimization by submaps.
struct SubmapReport {
  int submaps = 0;
  int links = 0;
  /// chi2 of all edges before the joint refinement: the price of the division.
  double chi2_before_refinement = 0;
  double partition_s = 0;
  double submaps_s = 0;     ///< every submap in its own frame
  double links_s = 0;       ///< condensing the edges between submaps, and their graph
  double refinement_s = 0;  ///< all poses together, from there
};

struct SubmapOptimizerResult {
  PoseOptimizerResult result;
  SubmapReport submaps;
};

/// The optimum of optimize(), reached by submaps: min-Ncut partition of the graph (an arc weighs as
/// many edges as join its nodes; large graphs are coarsened to some sixteen aggregates a submap
/// first), every submap optimized in the frame of its first node, the edges between two submaps
/// condensed into one relative pose of their frames with its covariance, the graph of submaps
/// optimized, and all poses refined together from there. Submaps and links run on
/// `options.threads`; the result does not depend on their number.
///
/// `submap_size` >= 2 is the mean number of nodes of a submap. Takes robust none only: a false edge
/// would bend its submap before anything could contradict it. Throws InputError like
/// optimize(), and for a graph with points.
SubmapOptimizerResult optimize_by_submaps(const PoseGraph& graph,
                                          const PoseOptimizerOptions& options,
                                          int submap_size = 500);

}  // namespace hmt::graph
