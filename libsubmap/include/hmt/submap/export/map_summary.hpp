// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hmt/submap/map/hybrid_map.hpp"

namespace hmt::submap {

/// One submap in numbers.
struct SubmapSummary {
  int id = 0;
  int64_t keyframes = 0;
  int64_t observations = 0;
  double first_stamp_s = 0;  ///< of its first keyframe in the order of the log
  double last_stamp_s = 0;   ///< of its last one
  /// Sides of the box around the robot's keyframe poses, axes of the submap, metres.
  Eigen::Vector3d extent_m = Eigen::Vector3d::Zero();
};

/// All submaps in numbers, by id.
std::vector<SubmapSummary> summarize_submaps(const HybridMap& map);

/// How many constraints of each kind a link is made of.
struct EvidenceCount {
  int64_t odometry = 0;
  int64_t registration = 0;
  int64_t loop = 0;
};
EvidenceCount count_evidence(const HybridMap& map, const Link& link);

/// Number of loop-closure candidates of each verdict, by its name; all verdicts are there.
std::map<std::string, int64_t> count_verdicts(const HybridMap& map);
/// Name of a verdict as files and reports have it, e.g. "low_score".
std::string verdict_name(LoopVerdict verdict);

}  // namespace hmt::submap
