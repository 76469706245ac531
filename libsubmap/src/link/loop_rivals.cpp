// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_rivals.hpp"

#include <Eigen/LU>
#include <map>
#include <vector>

namespace hmt::submap {
namespace {

/// Scores whose ratio is above are close.
constexpr double kCloseScores = 0.85;
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

void refuse(LoopCandidate& candidate, const LoopCandidate& rival) {
  candidate.verdict = LoopVerdict::ambiguous;
  candidate.reason =
      "keyframe " + std::to_string(rival.a) + " has a match for the same keyframe at another place";
}

}  // namespace

void refuse_rivals(const LoopProblem& problem, std::span<LoopCandidate> candidates) {
  std::map<int, std::vector<size_t>> accepted;
  for (size_t i = 0; i < candidates.size(); ++i)
    if (candidates[i].verdict == LoopVerdict::accepted) accepted[candidates[i].b].push_back(i);
  for (const auto& [b, indices] : accepted)
    for (size_t i = 0; i < indices.size(); ++i)
      for (size_t j = i + 1; j < indices.size(); ++j) {
        LoopCandidate& left = candidates[indices[i]];
        LoopCandidate& right = candidates[indices[j]];
        if (!contradict(problem, left, right)) continue;
        const bool close =
            std::min(left.score, right.score) > kCloseScores * std::max(left.score, right.score);
        if (close || left.score < right.score) refuse(left, right);
        if (close || right.score <= left.score) refuse(right, left);
      }
}

}  // namespace hmt::submap
