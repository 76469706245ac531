// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "hmt/submap/map/hybrid_map.hpp"

namespace hmt::submap {

/// The graph of submaps and links as JSON: members `space`, `information_loss`, `submaps` (id,
/// keyframes, observations, first and last stamp, T_world_submap as x y z qx qy qz qw, covariance)
/// and `links` (a, b, T_a_b, covariance, evidence by kind, ncut, information_loss). Covariances
/// are 36 numbers, row by row, in the tangent of Pose; frame of the submap, or of b.
std::string topology_json(const HybridMap& map);
/// The same graph as GraphML, with the numbers that are not matrices.
std::string topology_graphml(const HybridMap& map);
/// The same graph for Graphviz (neato -n), submaps at their places in the world.
std::string topology_dot(const HybridMap& map);

/// One line a keyframe: keyframe,stamp_s,submap.
std::string partition_csv(const HybridMap& map);
/// One JSON object a line for every loop-closure candidate.
std::string loops_jsonl(const HybridMap& map);
/// The submaps and links as a pose graph in the format of g2o.
std::string pose_graph_g2o(const HybridMap& map);

}  // namespace hmt::submap
