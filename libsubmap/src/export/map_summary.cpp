// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/map_summary.hpp"

#include <array>

namespace hmt::submap {
namespace {

constexpr std::array kVerdictNames = {"accepted",    "low_score",    "ambiguous",
                                      "unconfirmed", "contradicted", "inconsistent",
                                      "outlier",     "rejected",     "confirmed"};

Eigen::Vector3d extent(const Submap& submap) {
  Eigen::Vector3d low = submap.T_submap_keyframe.at(0).translation;
  Eigen::Vector3d high = low;
  for (const Pose& pose : submap.T_submap_keyframe) {
    low = low.cwiseMin(pose.translation);
    high = high.cwiseMax(pose.translation);
  }
  return high - low;
}

}  // namespace

std::vector<SubmapSummary> summarize_submaps(const HybridMap& map) {
  std::vector<SubmapSummary> summaries;
  for (const Submap& submap : map.submaps) {
    SubmapSummary summary;
    summary.id = submap.id;
    summary.keyframes = static_cast<int64_t>(submap.keyframes.size());
    const auto stamp = [&](int keyframe) {
      return map.track.keyframes.at(static_cast<size_t>(keyframe)).stamp_s;
    };
    summary.first_stamp_s = stamp(submap.keyframes.front());
    summary.last_stamp_s = stamp(submap.keyframes.back());
    summary.extent_m = extent(submap);
    summaries.push_back(summary);
  }
  for (const TrackedObservation& tracked : map.track.observations) {
    const int id = map.submap_of_keyframe.at(static_cast<size_t>(tracked.keyframe));
    ++summaries.at(static_cast<size_t>(id)).observations;
  }
  return summaries;
}

EvidenceCount count_evidence(const HybridMap& map, const Link& link) {
  EvidenceCount count;
  for (const int index : link.evidence) {
    const ConstraintKind kind = map.constraints.at(static_cast<size_t>(index)).kind;
    if (kind == ConstraintKind::odometry) ++count.odometry;
    if (kind == ConstraintKind::registration) ++count.registration;
    if (kind == ConstraintKind::loop || kind == ConstraintKind::confirmed) ++count.loop;
  }
  return count;
}

std::map<std::string, int64_t> count_verdicts(const HybridMap& map) {
  std::map<std::string, int64_t> counts;
  for (const char* name : kVerdictNames) counts[name] = 0;
  for (const LoopCandidate& loop : map.loops) ++counts[verdict_name(loop.verdict)];
  return counts;
}

std::string verdict_name(LoopVerdict verdict) {
  return kVerdictNames.at(static_cast<size_t>(verdict));
}

}  // namespace hmt::submap
