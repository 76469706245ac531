// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_proposals.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "loop_patch.hpp"
#include "parallel.hpp"

namespace hmt::submap {
namespace {

/// Travel between places that make maps, which overlap by half.
constexpr double kMapSpacingM = 4.0;
/// Robots this close to each other see the same surfaces.
constexpr double kMeetM = 5.0;
/// chi2 of two degrees of freedom at 99.7 %, as a distance.
constexpr double kGate = 3.41;
/// Of one visit only places this far apart are searched: the map of one reaches to the next.
constexpr double kVisitSpacingM = 8.0;
constexpr size_t kMostMapsPerQuery = 6;
/// A map shows what a map of an earlier visit shows if it stands this close to it, looks the same
/// way and is tied to it; so many of the nearest are asked for that.
constexpr double kSameMapM = kMapSpacingM / 2;
constexpr double kSameMapRad = 0.5;
constexpr size_t kMostSameMaps = 4;
/// Candidates whose covariance is asked for, per query; the nearest by a bound of it.
constexpr size_t kMostRatedPerQuery = 24;
constexpr double kUnknownSigmaM = 1e3;
/// Relative poses known as well as this need no search.
constexpr double kKnownSigmaM = 0.1;
constexpr double kKnownSigmaRad = 0.01;

struct Rated {
  double mahalanobis = 0;  ///< of the gap between the sensed regions
  double distance_m = 0;
  LoopProposal proposal;
};

/// A keyframe that makes a map or a query.
struct Place {
  int keyframe = 0;
  int limit = 0;       ///< last keyframe of the map, first keyframe of the query
  double sigma_m = 0;  ///< of the position relative to the first keyframe of the log
  Eigen::Vector3d t_world = Eigen::Vector3d::Zero();
};

/// From keyframe `first` on.
std::vector<Place> places(const LoopProblem& problem, std::span<const double> path_m, int first,
                          double spacing_m, const std::function<int(int)>& limit, int threads) {
  std::vector<Place> found;
  for (int k = first; k < static_cast<int>(path_m.size()); ++k) {
    const auto i = static_cast<size_t>(k);
    if (!found.empty() &&
        path_m[i] - path_m[static_cast<size_t>(found.back().keyframe)] < spacing_m)
      continue;
    found.push_back({k, limit(k), 0.0, problem.T_world_keyframe[i].translation});
  }
  for_each_index(0, found.size(), threads, [&](size_t i) {
    if (found[i].keyframe == 0) return;
    const auto covariance = problem.covariance(0, found[i].keyframe);
    // Not connected to the first keyframe: near to everything, as far as can be told.
    found[i].sigma_m =
        covariance ? std::sqrt(covariance->topLeftCorner<2, 2>().trace()) : kUnknownSigmaM;
  });
  return found;
}

/// Whether a map shows what one of some earlier maps shows.
bool is_repeated(const LoopProblem& problem, std::span<const Place> earlier, const Place& map) {
  std::vector<std::pair<double, int>> near;
  for (const Place& other : earlier) {
    const double distance_m = (other.t_world - map.t_world).norm();
    if (distance_m > kSameMapM) continue;
    const Pose T =
        graph::relative_pose(problem.T_world_keyframe[static_cast<size_t>(other.keyframe)],
                             problem.T_world_keyframe[static_cast<size_t>(map.keyframe)]);
    if (std::abs(T.yaw_rad()) < kSameMapRad) near.emplace_back(distance_m, other.keyframe);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), kMostSameMaps));
  return std::any_of(near.begin(), near.end(), [&](const auto& other) {
    return problem.already_tied(other.second, map.keyframe);
  });
}

/// Maps that show something else: a robot that goes its rounds needs no map of each, and there are
/// no more once its rounds are tied to each other.
std::vector<Place> without_repetitions(const LoopProblem& problem, std::vector<Place> maps) {
  if (!problem.already_tied) return maps;
  std::vector<Place> kept;
  for (const Place& map : maps)
    if (!is_repeated(problem, kept, map)) kept.push_back(map);
  return kept;
}

/// The maps before a query that it may reach, the nearest ones. The covariance of a pair is at most
/// that of two independent positions.
std::vector<int> nearest_maps(const LoopProblem& problem, std::span<const Place> maps,
                              const Place& query) {
  std::vector<std::pair<double, int>> near;
  for (const Place& map : maps) {
    if (map.limit >= query.limit) break;
    const double distance_m = (map.t_world - query.t_world).norm();
    if (distance_m > kMeetM + kGate * (map.sigma_m + query.sigma_m)) continue;
    near.emplace_back(distance_m, map.keyframe);
  }
  std::sort(near.begin(), near.end());
  std::vector<int> nearest;
  for (const auto& [distance_m, a] : near) {
    if (nearest.size() == kMostRatedPerQuery) break;
    if (!problem.already_tied || !problem.already_tied(a, query.keyframe)) nearest.push_back(a);
  }
  return nearest;
}

/// Whether registration alone, from the prediction, finds what there is to find.
bool is_known(const Matrix6d& covariance) {
  return covariance.topLeftCorner<2, 2>().trace() < kKnownSigmaM * kKnownSigmaM &&
         covariance(5, 5) < kKnownSigmaRad * kKnownSigmaRad;
}

std::optional<Rated> rate(const LoopProblem& problem, int a, int b) {
  const auto covariance = problem.covariance(a, b);
  if (!covariance || is_known(*covariance)) return std::nullopt;
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

std::vector<LoopProposal> propose_loops(const LoopProblem& problem, std::span<const double> path_m,
                                        int threads) {
  const std::vector<Place> maps = without_repetitions(
      problem, places(
                   problem, path_m, 0, kMapSpacingM,
                   [&](int k) { return patch_range(path_m, k, kMapReachM).second; }, threads));
  const std::vector<Place> queries = places(
      problem, path_m, problem.first_query, problem.query_spacing_m,
      [&](int k) { return patch_range(path_m, k, kQueryReachM).first; }, threads);
  std::vector<std::vector<LoopProposal>> of_query(queries.size());
  for_each_index(0, queries.size(), threads, [&](size_t i) {
    std::vector<Rated> rated;
    for (const int a : nearest_maps(problem, maps, queries[i]))
      if (auto r = rate(problem, a, queries[i].keyframe)) rated.push_back(std::move(*r));
    of_query[i] = choose(std::move(rated), path_m);
  });
  std::vector<LoopProposal> all;
  for (const auto& proposals : of_query) all.insert(all.end(), proposals.begin(), proposals.end());
  std::sort(all.begin(), all.end(), [](const LoopProposal& l, const LoopProposal& r) {
    return std::pair(l.a, l.b) < std::pair(r.a, r.b);
  });
  return all;
}

}  // namespace hmt::submap
