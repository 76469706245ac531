// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_verify.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace hmt::submap {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr double kCellM = 0.1;
constexpr double kGridSigmaM = 0.1;
constexpr int kLevels = 5;
constexpr double kQueryRangeM = 15.0;
constexpr size_t kMostQueryPoints = 300;

/// chi2 of three degrees of freedom at 99.7 %, as a distance.
constexpr double kGate = 3.73;
/// What the covariance does not know: the patches' own drift, and room to see a rival match.
constexpr double kWindowMarginM = 1.0;
constexpr double kWindowMarginRad = 5.0 * kDegree;
constexpr double kWidestM = 15.0;

constexpr double kSameMatchM = 0.6;
constexpr double kSameMatchRad = 10.0 * kDegree;

constexpr double kLeastScore = 0.35;
constexpr double kMostSecondShare = 0.85;
constexpr double kMostConflict = 0.10;
constexpr double kLeastInliers = 0.5;
constexpr double kMostShiftM = 0.4;
constexpr double kMostTurnRad = 4.0 * kDegree;
constexpr size_t kMostSourcePoints = 500;

std::vector<Eigen::Vector2f> query_points(const LoopPatch& query) {
  std::vector<Eigen::Vector2f> near;
  for (const Eigen::Vector2f& p : query.points_center)
    if (p.norm() < kQueryRangeM) near.push_back(p);
  const size_t stride = (near.size() + kMostQueryPoints - 1) / kMostQueryPoints;
  std::vector<Eigen::Vector2f> chosen;
  for (size_t i = 0; i < near.size(); i += stride) chosen.push_back(near[i]);
  return chosen;
}

CorrelativeWindow window_of(const LoopProposal& proposal) {
  const Eigen::Matrix3d R = proposal.T_a_b.rotation_matrix();
  const Eigen::Matrix3d in_a = R * proposal.covariance.topLeftCorner<3, 3>() * R.transpose();
  const auto half = [](double variance, double margin, double widest) {
    return std::min(widest, kGate * std::sqrt(std::max(0.0, variance)) + margin);
  };
  return {proposal.T_a_b, half(in_a(0, 0), kWindowMarginM, kWidestM),
          half(in_a(1, 1), kWindowMarginM, kWidestM),
          half(proposal.covariance(5, 5), kWindowMarginRad, std::numbers::pi)};
}

/// In the plane: x, y and heading, with what the covariance does not know added.
double mahalanobis(const LoopProposal& proposal, const Pose& T_a_b) {
  const Vector6d d = graph::boxminus(T_a_b, proposal.T_a_b);
  const Eigen::Array3i planar(0, 1, 5);
  Eigen::Matrix3d covariance = proposal.covariance(planar, planar);
  covariance.diagonal() += Eigen::Vector3d(0.01, 0.01, kDegree * kDegree);
  const Eigen::Vector3d e = d(planar);
  return std::sqrt(e.dot(covariance.ldlt().solve(e)));
}

bool near(const Pose& left, const Pose& right) {
  return (left.translation - right.translation).norm() < kMostShiftM &&
         std::abs(graph::wrap_angle(left.yaw_rad() - right.yaw_rad())) < kMostTurnRad;
}

template <typename... Numbers>
std::string text(const char* format, Numbers... numbers) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, numbers...);
  return buffer;
}

LoopCandidate refuse(LoopCandidate candidate, LoopVerdict verdict, std::string reason) {
  candidate.verdict = verdict;
  candidate.reason = std::move(reason);
  return candidate;
}

}  // namespace

LoopMap::LoopMap(const LoopProblem& problem, LoopPatch patch)
    : problem_(problem),
      patch_(std::move(patch)),
      grid_(patch_.points_center, kCellM, kGridSigmaM, kLevels) {}

const RegistrationTarget& LoopMap::target() {
  if (!target_) target_.emplace(patch_target(problem_, patch_));
  return *target_;
}

LoopCandidate examine_loop(const LoopProblem& problem, std::span<const PlanarScan> scans,
                           LoopMap& map, const LoopPatch& query, const LoopProposal& proposal) {
  LoopCandidate candidate;
  candidate.a = proposal.a;
  candidate.b = proposal.b;
  candidate.submap_a = problem.submap[static_cast<size_t>(proposal.a)];
  candidate.submap_b = problem.submap[static_cast<size_t>(proposal.b)];
  candidate.T_a_b = proposal.T_a_b;
  const std::vector<Eigen::Vector2f> points = query_points(query);
  const CorrelativeWindow window = window_of(proposal);
  const auto best = correlative_search(map.grid(), points, window, 0.5 * kLeastScore);
  if (!best)
    return refuse(candidate, LoopVerdict::low_score, "nothing in the window resembles the query");
  candidate.T_a_b = best->T_map_query;
  candidate.score = best->score;
  candidate.mahalanobis = mahalanobis(proposal, candidate.T_a_b);
  if (best->score < kLeastScore)
    return refuse(candidate, LoopVerdict::low_score,
                  text("only %.0f %% of the points meet a surface of the map", 100 * best->score));
  const auto second =
      correlative_search(map.grid(), points, window, 0.5 * best->score,
                         CorrelativeExclusion{best->T_map_query, kSameMatchM, kSameMatchRad});
  candidate.second_score = second ? second->score : 0.0;
  candidate.free_space_conflict =
      std::max(seen_through_share(map.patch(), scans, query, candidate.T_a_b),
               seen_through_share(query, scans, map.patch(), candidate.T_a_b.inverse()));
  if (candidate.second_score > kMostSecondShare * candidate.score)
    return refuse(
        candidate, LoopVerdict::ambiguous,
        text("another match scores %.2f against %.2f", candidate.second_score, candidate.score));
  if (candidate.free_space_conflict > kMostConflict)
    return refuse(candidate, LoopVerdict::contradicted,
                  text("%.0f %% of the points lie where the other visit saw through",
                       100 * candidate.free_space_conflict));

  RegistrationOptions options;
  options.space = problem.space;
  const Registration forward = register_surface(patch_surface(problem, query, kMostSourcePoints),
                                                map.target(), candidate.T_a_b, options);
  candidate.inlier_fraction = forward.inlier_fraction;
  candidate.rmse_m = forward.rmse_m;
  if (forward.termination == Registration::Termination::too_few_points)
    return refuse(candidate, LoopVerdict::unconfirmed, "too few points to register");
  if (!near(forward.T_target_source, candidate.T_a_b))
    return refuse(candidate, LoopVerdict::unconfirmed, "the registration left the match");
  if (forward.inlier_fraction < kLeastInliers)
    return refuse(candidate, LoopVerdict::unconfirmed,
                  text("the registration explains only %.0f %%", 100 * forward.inlier_fraction));
  candidate.T_a_b = forward.T_target_source;
  candidate.information = forward.information;
  candidate.mahalanobis = mahalanobis(proposal, candidate.T_a_b);
  candidate.verdict = LoopVerdict::accepted;
  candidate.reason = text("score %.2f, second %.2f, %.0f %% inliers", candidate.score,
                          candidate.second_score, 100 * candidate.inlier_fraction);
  return candidate;
}

}  // namespace hmt::submap
