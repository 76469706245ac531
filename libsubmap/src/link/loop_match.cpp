// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_match.hpp"

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
constexpr size_t kMostQueryPoints = 300;

/// chi2 of three degrees of freedom as a distance: what is searched (99.7 %) and what is believed
/// (99 %). Where places repeat themselves nothing but the prediction tells them apart.
constexpr double kWindowGate = 3.73;
constexpr double kBeliefGate = 3.37;
/// What the covariance does not know: the patches' own drift, and room to see a rival match.
constexpr double kWindowMarginM = 1.0;
constexpr double kWindowMarginRad = 5.0 * kDegree;
constexpr double kWidestM = 15.0;

constexpr double kSameMatchM = 0.6;
constexpr double kSameMatchRad = 10.0 * kDegree;

constexpr double kLeastScore = 0.35;
constexpr double kMostSecondShare = 0.85;
/// Lower second scores are not told apart: they do not matter and would cost time.
constexpr double kSecondFloor = 0.7;
constexpr double kMostConflict = 0.10;

std::vector<Eigen::Vector2f> query_points(const LoopPatch& query, Space space) {
  std::vector<Eigen::Vector2f> near;
  for (const Eigen::Vector2f& p : query.points_center)
    if (p.norm() < query_range_m(space)) near.push_back(p);
  const size_t stride = (near.size() + kMostQueryPoints - 1) / kMostQueryPoints;
  std::vector<Eigen::Vector2f> chosen;
  for (size_t i = 0; i < near.size(); i += stride) chosen.push_back(near[i]);
  return chosen;
}

/// Around the places of the two centers, seen from above.
CorrelativeWindow window_of(const LoopProposal& proposal, const LoopPatch& map,
                            const LoopPatch& query, Space space) {
  const Pose T_level = map.T_level_center * proposal.T_a_b * query.T_level_center.inverse();
  const Eigen::Matrix3d R = proposal.T_a_b.rotation_matrix();
  const Eigen::Matrix3d in_a = R * proposal.covariance.topLeftCorner<3, 3>() * R.transpose();
  const auto half = [](double variance, double margin, double widest) {
    return std::min(widest, kWindowGate * std::sqrt(std::max(0.0, variance)) + margin);
  };
  return {level_pose(space, T_level).T_world_level, half(in_a(0, 0), kWindowMarginM, kWidestM),
          half(in_a(1, 1), kWindowMarginM, kWidestM),
          half(proposal.covariance(5, 5), kWindowMarginRad, std::numbers::pi)};
}

/// What the grid alone tells of a match.
Matrix6d match_information() {
  Vector6d sigma = Vector6d::Zero();
  sigma << kGridSigmaM, kGridSigmaM, 0, 0, 0, kDegree;
  Matrix6d information = Matrix6d::Zero();
  for (const int k : {0, 1, 5}) information(k, k) = 1 / (sigma[k] * sigma[k]);
  return information;
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

LoopCandidate start(const LoopProblem& problem, const LoopProposal& proposal) {
  LoopCandidate candidate;
  candidate.a = proposal.a;
  candidate.b = proposal.b;
  candidate.submap_a = problem.submap[static_cast<size_t>(proposal.a)];
  candidate.submap_b = problem.submap[static_cast<size_t>(proposal.b)];
  candidate.T_a_b = proposal.T_a_b;
  candidate.predicted_distance_m = proposal.T_a_b.translation.norm();
  candidate.predicted_sigma_m = std::sqrt(proposal.covariance.topLeftCorner<3, 3>().trace());
  return candidate;
}

/// Share of the points that one visit saw and the other looked through, the larger of both ways.
double free_space_conflict(std::span<const PlanarScan> scans, const LoopPatch& map,
                           const LoopPatch& query, const Pose& T_map_query) {
  return std::max(seen_through_share(map, scans, query, T_map_query),
                  seen_through_share(query, scans, map, T_map_query.inverse()));
}

void take(const LoopProblem& problem, const LoopConfirmation& confirmation,
          LoopCandidate& candidate) {
  candidate.a = confirmation.a;
  candidate.submap_a = problem.submap[static_cast<size_t>(confirmation.a)];
  candidate.T_a_b = confirmation.T_a_b;
  candidate.information = confirmation.information;
  candidate.verdict = LoopVerdict::accepted;
  candidate.reason = text("%.0f %% of the points meet the map, %.0f %% at the best other place",
                          100 * candidate.score, 100 * candidate.second_score);
}

}  // namespace

LoopMap::LoopMap(const LoopProblem& problem, LoopPatch patch)
    : patch_(std::move(patch)),
      grid_(patch_.points_center, kCellM, kGridSigmaM, kLevels),
      confirmer_(problem, patch_) {}

LoopCandidate examine_loop(const LoopProblem& problem, std::span<const PlanarScan> scans,
                           LoopMap& map, const LoopPatch& query, const LoopProposal& proposal) {
  LoopCandidate candidate = start(problem, proposal);
  const std::vector<Eigen::Vector2f> points = query_points(query, problem.space);
  const CorrelativeWindow window = window_of(proposal, map.patch(), query, problem.space);
  const auto best = correlative_search(map.grid(), points, window, kLeastScore);
  if (!best)
    return refuse(candidate, LoopVerdict::low_score,
                  text("nowhere do %.0f %% of the points meet the map", 100 * kLeastScore));
  // Height and tilt are those of the prediction.
  candidate.T_a_b = map.patch().T_level_center.inverse() * best->T_map_query * query.T_level_center;
  candidate.information = match_information();
  candidate.score = best->score;
  candidate.mahalanobis = mahalanobis(proposal, candidate.T_a_b);
  if (candidate.mahalanobis > kBeliefGate)
    return refuse(
        candidate, LoopVerdict::unconfirmed,
        text("the best match lies %.1f sigma from the prediction", candidate.mahalanobis));
  const double floor = kSecondFloor * best->score;
  const auto second =
      correlative_search(map.grid(), points, window, floor,
                         CorrelativeExclusion{best->T_map_query, kSameMatchM, kSameMatchRad});
  candidate.second_score = second ? second->score : floor;
  if (candidate.second_score > kMostSecondShare * candidate.score)
    return refuse(candidate, LoopVerdict::ambiguous,
                  text("%.0f %% of the points meet the map, but %.0f %% do so elsewhere",
                       100 * candidate.score, 100 * candidate.second_score));
  candidate.free_space_conflict = free_space_conflict(scans, map.patch(), query, candidate.T_a_b);
  if (candidate.free_space_conflict > kMostConflict)
    return refuse(candidate, LoopVerdict::contradicted,
                  text("%.0f %% of the points lie where the other visit saw through",
                       100 * candidate.free_space_conflict));
  const LoopConfirmation confirmation = map.confirmer().confirm(query, candidate.T_a_b);
  candidate.inlier_fraction = confirmation.inlier_fraction;
  candidate.rmse_m = confirmation.rmse_m;
  if (!confirmation.objection.empty())
    return refuse(candidate, LoopVerdict::unconfirmed, confirmation.objection);
  take(problem, confirmation, candidate);
  return candidate;
}

}  // namespace hmt::submap
