// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_rivals.hpp"

#include <Eigen/LU>
#include <map>
#include <vector>

namespace hmt::submap {
namespace {

/// A rival with less than this share of a match's score is no rival: the two maps may show
/// different parts of what was seen.
constexpr double kRivalShare = 0.6;
/// What neither covariance knows: the drift within the maps.
constexpr double kMapSigmaM = 0.15;
constexpr double kMapSigmaRad = 0.02;
/// 99.7 % of chi2 with three degrees of freedom.
constexpr double kGate2 = 13.9;

bool contradict(const LoopProblem& problem, const LoopCandidate& left, const LoopCandidate& right) {
  if (left.a > right.a) return contradict(problem, right, left);
  Matrix6d covariance_b = Matrix6d::Zero();
  if (left.a != right.a) {
    const auto covariance = problem.covariance(left.a, right.a);
    if (!covariance) return false;
    const Matrix6d to_b = graph::adjoint(right.T_a_b.inverse());
    covariance_b = to_b * *covariance * to_b.transpose();
  }
  const Pose T_left_right =
      graph::relative_pose(problem.T_world_keyframe[static_cast<size_t>(left.a)],
                           problem.T_world_keyframe[static_cast<size_t>(right.a)]);
  const Eigen::Array3i planar(0, 1, 5);
  const Eigen::Vector3d d = graph::boxminus(left.T_a_b, T_left_right * right.T_a_b)(planar);
  Eigen::Matrix3d covariance = covariance_b(planar, planar);
  covariance.diagonal() += Eigen::Vector3d(kMapSigmaM, kMapSigmaM, kMapSigmaRad).cwiseAbs2();
  return d.dot(covariance.inverse() * d) > kGate2;
}

/// What the prediction or the other's free space speaks against is no rival.
bool is_match(const LoopCandidate& candidate) {
  return candidate.score > 0 && candidate.verdict != LoopVerdict::contradicted &&
         candidate.mahalanobis * candidate.mahalanobis < kGate2;
}

}  // namespace

void refuse_rivals(const LoopProblem& problem, std::span<LoopCandidate> candidates) {
  std::map<int, std::vector<LoopCandidate>> matches;
  for (const LoopCandidate& candidate : candidates)
    if (is_match(candidate)) matches[candidate.b].push_back(candidate);
  for (LoopCandidate& candidate : candidates) {
    if (candidate.verdict != LoopVerdict::accepted) continue;
    for (const LoopCandidate& other : matches[candidate.b]) {
      if (other.score < kRivalShare * candidate.score) continue;
      if (!contradict(problem, candidate, other)) continue;
      candidate.verdict = LoopVerdict::ambiguous;
      candidate.reason =
          "around keyframe " + std::to_string(other.a) + " there is a match at another place";
      break;
    }
  }
}

}  // namespace hmt::submap
