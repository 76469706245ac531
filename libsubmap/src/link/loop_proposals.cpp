// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_proposals.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "loop_patch.hpp"

namespace hmt::submap {
namespace {

/// Travel between places. Maps overlap by half; each place is queried by several neighbors.
constexpr double kMapSpacingM = 4.0;
constexpr double kQuerySpacingM = 2.0;
/// Robots this close to each other see the same surfaces.
constexpr double kMeetM = 5.0;
/// chi2 of two degrees of freedom at 99.7 %, as a distance.
constexpr double kGate = 3.41;
/// Of one visit only places this far apart are searched: the map of one reaches to the next.
constexpr double kVisitSpacingM = 8.0;
constexpr size_t kMostMapsPerQuery = 6;
/// Candidates whose covariance is asked for, per query; the nearest by a bound of it.
constexpr size_t kMostRatedPerQuery = 24;

struct Rated {
  double mahalanobis = 0;  ///< of the gap between the sensed regions
  double distance_m = 0;
  LoopProposal proposal;
};

std::vector<int> places(std::span<const double> path_m, double spacing_m) {
  std::vector<int> centers;
  for (int k = 0; k < static_cast<int>(path_m.size()); ++k)
    if (centers.empty() ||
        path_m[static_cast<size_t>(k)] - path_m[static_cast<size_t>(centers.back())] >= spacing_m)
      centers.push_back(k);
  return centers;
}

/// Standard deviation of the position relative to the first keyframe, largest direction.
std::vector<double> position_sigma(const LoopProblem& problem, std::span<const int> centers) {
  std::vector<double> sigma_m;
  for (const int k : centers) {
    const auto covariance = k == 0 ? Matrix6d(Matrix6d::Zero()) : problem.covariance(0, k);
    sigma_m.push_back(covariance ? std::sqrt(covariance->topLeftCorner<2, 2>().trace()) : -1.0);
  }
  return sigma_m;
}

std::optional<Rated> rate(const LoopProblem& problem, int a, int b) {
  const auto covariance = problem.covariance(a, b);
  if (!covariance) return std::nullopt;
  Rated rated;
  rated.proposal = {a, b,
                    graph::relative_pose(problem.T_world_keyframe[static_cast<size_t>(a)],
                                         problem.T_world_keyframe[static_cast<size_t>(b)]),
                    *covariance};
  rated.distance_m = rated.proposal.T_a_b.translation.head<2>().norm();
  const double gap_m = std::max(0.0, rated.distance_m - kMeetM);
  if (gap_m > 0) {
    const Eigen::Vector2d towards_a_b =
        rated.proposal.T_a_b.rotation_matrix().transpose().topLeftCorner<2, 2>() *
        rated.proposal.T_a_b.translation.head<2>().normalized();
    const double variance = towards_a_b.dot(covariance->topLeftCorner<2, 2>() * towards_a_b);
    rated.mahalanobis = variance > 0 ? gap_m / std::sqrt(variance) : 1e9;
  }
  if (rated.mahalanobis > kGate) return std::nullopt;
  return rated;
}

/// The nearest of each visit, visits in the order of distance.
std::vector<LoopProposal> choose(std::vector<Rated> rated, std::span<const double> path_m) {
  std::stable_sort(rated.begin(), rated.end(), [](const Rated& l, const Rated& r) {
    if (l.mahalanobis != r.mahalanobis) return l.mahalanobis < r.mahalanobis;
    return l.distance_m < r.distance_m;
  });
  std::vector<LoopProposal> chosen;
  for (const Rated& candidate : rated) {
    const double at = path_m[static_cast<size_t>(candidate.proposal.a)];
    const bool near = std::any_of(chosen.begin(), chosen.end(), [&](const LoopProposal& c) {
      return std::abs(path_m[static_cast<size_t>(c.a)] - at) < kVisitSpacingM;
    });
    if (!near) chosen.push_back(candidate.proposal);
    if (chosen.size() == kMostMapsPerQuery) break;
  }
  return chosen;
}

}  // namespace

std::vector<LoopProposal> propose_loops(const LoopProblem& problem,
                                        std::span<const double> path_m) {
  const std::vector<int> maps = places(path_m, kMapSpacingM);
  const std::vector<int> queries = places(path_m, kQuerySpacingM);
  const std::vector<double> map_sigma = position_sigma(problem, maps);
  const std::vector<double> query_sigma = position_sigma(problem, queries);
  std::vector<LoopProposal> all;
  for (size_t j = 0; j < queries.size(); ++j) {
    const int b = queries[j];
    const int first_b = patch_range(path_m, b, kQueryReachM).first;
    const Eigen::Vector3d& t_b = problem.T_world_keyframe[static_cast<size_t>(b)].translation;
    std::vector<std::pair<double, int>> near;
    for (size_t i = 0; i < maps.size() && maps[i] < b; ++i) {
      const double bound_m = kMeetM + kGate * (map_sigma[i] + query_sigma[j]);
      const Eigen::Vector3d& t_a =
          problem.T_world_keyframe[static_cast<size_t>(maps[i])].translation;
      const double distance_m = (t_a - t_b).norm();
      if (distance_m > bound_m) continue;
      if (patch_range(path_m, maps[i], kMapReachM).second >= first_b) continue;
      if (problem.already_tied && problem.already_tied(maps[i], b)) continue;
      near.emplace_back(distance_m, maps[i]);
    }
    std::sort(near.begin(), near.end());
    if (near.size() > kMostRatedPerQuery) near.resize(kMostRatedPerQuery);
    std::vector<Rated> rated;
    for (const auto& [distance_m, a] : near)
      if (auto r = rate(problem, a, b)) rated.push_back(std::move(*r));
    for (const LoopProposal& proposal : choose(std::move(rated), path_m)) all.push_back(proposal);
  }
  std::sort(all.begin(), all.end(), [](const LoopProposal& l, const LoopProposal& r) {
    return std::pair(l.a, l.b) < std::pair(r.a, r.b);
  });
  return all;
}

}  // namespace hmt::submap
