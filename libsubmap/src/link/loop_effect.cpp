// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/link/loop_effect.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "hmt/graph/pose_covariance.hpp"

namespace hmt::submap {
namespace {

using Pair = std::pair<int, int>;

/// Travel within which two pairs of keyframes belong to one revisit: twice what a local map covers
/// to one side.
constexpr double kSameRevisit_m = 16;
constexpr double kSameMatch_m = 1;
constexpr double kSameMatch_rad = 0.2;
/// Of the directions that the candidate alone fixes its own residual is zero up to rounding.
constexpr double kAlone = 1e-9;

/// sum_k u_k^2 / (1 + sign m_k), m and u the eigenvalues of L^T P L and L^T r in its basis.
double chi2_rise(const Vector6d& residual, const Matrix6d& information, const Matrix6d& covariance,
                 double sign) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> of_information(information);
  const Matrix6d L = of_information.eigenvectors() *
                     of_information.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(L.transpose() * covariance * L);
  const Vector6d u = eigen.eigenvectors().transpose() * L.transpose() * residual;
  double rise = 0;
  for (int k = 0; k < 6; ++k) {
    const double scale = 1 + sign * eigen.eigenvalues()[k];
    if (scale > kAlone) rise += u[k] * u[k] / scale;
  }
  return rise;
}

}  // namespace

void rate_effects(std::vector<LoopCandidate>& candidates, const graph::PoseGraph& solved,
                  std::span<const Constraint> constraints, int threads) {
  std::set<Pair> used;
  for (const Constraint& c : constraints)
    if (c.kind == ConstraintKind::loop || c.kind == ConstraintKind::confirmed)
      used.emplace(c.a, c.b);
  std::vector<Pair> pairs;
  for (const LoopCandidate& c : candidates) pairs.emplace_back(c.a, c.b);
  const auto covariances = graph::PoseCovariance(solved).relative(pairs, threads);
  for (size_t k = 0; k < candidates.size(); ++k) {
    LoopCandidate& c = candidates[k];
    const bool is_used = is_closure(c.verdict) && used.contains({c.a, c.b});
    if (c.verdict == LoopVerdict::accepted && !is_used) {
      c.verdict = LoopVerdict::outlier;
      c.reason = "contradicts the constraints that were found later";
    }
    if (c.information.isZero(0) || !covariances[k]) continue;
    const Pose T_a_b = graph::relative_pose(solved.poses[static_cast<size_t>(c.a)],
                                            solved.poses[static_cast<size_t>(c.b)]);
    c.chi2_rise = chi2_rise(graph::boxminus(T_a_b, c.T_a_b), c.information, *covariances[k],
                            is_used ? -1 : 1);
  }
}

bool tells_the_same(const LoopCandidate& left, const LoopCandidate& right,
                    std::span<const Pose> T_world_keyframe, std::span<const double> path_m) {
  const auto at = [](auto values, int keyframe) { return values[static_cast<size_t>(keyframe)]; };
  if (std::abs(at(path_m, left.a) - at(path_m, right.a)) > kSameRevisit_m ||
      std::abs(at(path_m, left.b) - at(path_m, right.b)) > kSameRevisit_m)
    return false;
  const auto T = [&](int from, int to) {
    return graph::relative_pose(at(T_world_keyframe, from), at(T_world_keyframe, to));
  };
  const Pose by_right = T(left.a, right.a) * right.T_a_b * T(right.b, left.b);
  const Vector6d difference = graph::boxminus(by_right, left.T_a_b);
  return difference.head<3>().norm() < kSameMatch_m && difference.tail<3>().norm() < kSameMatch_rad;
}

std::vector<LoopCandidate> join_candidates(std::vector<LoopCandidate> earlier,
                                           std::vector<LoopCandidate> found) {
  std::map<Pair, size_t> place;
  for (size_t k = 0; k < earlier.size(); ++k) place.emplace(Pair(earlier[k].a, earlier[k].b), k);
  for (LoopCandidate& candidate : found) {
    const auto [at, is_new] = place.emplace(Pair(candidate.a, candidate.b), earlier.size());
    if (is_new) {
      earlier.push_back(std::move(candidate));
      continue;
    }
    LoopCandidate& before = earlier[at->second];
    if (!is_closure(before.verdict) && before.verdict != LoopVerdict::rejected)
      before = std::move(candidate);
  }
  return earlier;
}

}  // namespace hmt::submap
