// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/local/local_constraints.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "../registration/local_map.hpp"
#include "../registration/surface_store.hpp"
#include "hmt/submap/registration/register_surface.hpp"

namespace hmt::submap {
namespace {

using Neighbor = graph::WeightedGraph::Neighbor;

// Neighbors that are registered: consecutive keyframes carry the chain and two more stiffen it; a
// revisit is tied twice, which is enough to average its noise while a place seen ten times does not
// cost a hundred registrations.
constexpr size_t kSameVisit = 4;
constexpr size_t kOtherVisit = 2;
constexpr int kVisits = 5;
// A registration that is there counts as one of these if its overlap is among the best so many
// times as many: which of two like pairs overlaps more changes with every breath of the poses, and
// another registration each time would tell nothing new.
constexpr size_t kNearlyBest = 2;
// A registration must explain this share of the source's points relative to what the overlap
// promises.
constexpr double kMinExplained = 0.6;
// 99.9 % quantile of chi2 with six degrees of freedom, and more than that with three: disagreement
// beyond it is an error.
constexpr double kMaxMahalanobisSquared = 22.46;
bool more_overlap(const Neighbor& left, const Neighbor& right) {
  return left.weight != right.weight ? left.weight > right.weight : left.node < right.node;
}

/// Neighbors of a keyframe in runs of close ids: each run is one visit to the place.
std::vector<std::vector<Neighbor>> visits(std::span<const Neighbor> neighbors, double min_overlap) {
  std::vector<std::vector<Neighbor>> runs;
  for (const Neighbor& n : neighbors) {
    if (n.weight < min_overlap) continue;
    if (runs.empty() || n.node - runs.back().back().node > kVisitGap) runs.emplace_back();
    runs.back().push_back(n);
  }
  for (auto& run : runs) std::sort(run.begin(), run.end(), more_overlap);
  return runs;
}

using Pairs = std::set<std::pair<int, int>>;

/// The pairs of a keyframe with the best `most` of a visit, fewer where some are there.
void add_best(int keyframe, std::span<const Neighbor> visit, size_t most, const Pairs& there,
              Pairs& pairs) {
  const auto pair_of = [&](const Neighbor& n) { return std::pair(std::minmax(keyframe, n.node)); };
  const auto likely = visit.first(std::min(visit.size(), kNearlyBest * most));
  auto count = static_cast<size_t>(std::count_if(
      likely.begin(), likely.end(), [&](const Neighbor& n) { return there.contains(pair_of(n)); }));
  for (const Neighbor& n : visit.first(std::min(visit.size(), most))) {
    if (count >= most) return;
    if (there.contains(pair_of(n))) continue;
    pairs.insert(pair_of(n));
    ++count;
  }
}

/// Pairs a < b that are worth a registration, ordered.
std::vector<std::pair<int, int>> pairs_to_register(const graph::WeightedGraph& overlap,
                                                   double min_overlap,
                                                   std::span<const Constraint> known) {
  Pairs there;
  for (const Constraint& c : known) there.emplace(c.a, c.b);
  Pairs pairs;
  for (int i = 0; i < overlap.num_nodes(); ++i) {
    auto runs = visits(overlap.neighbors(i), min_overlap);
    const auto is_own = [i](const std::vector<Neighbor>& run) {
      return std::any_of(run.begin(), run.end(),
                         [i](const Neighbor& n) { return std::abs(n.node - i) <= kVisitGap; });
    };
    std::sort(runs.begin(), runs.end(),
              [](const auto& l, const auto& r) { return more_overlap(l.front(), r.front()); });
    int others = 0;
    for (const auto& run : runs) {
      const bool own = is_own(run);
      if (!own && ++others > kVisits) continue;
      add_best(i, run, own ? kSameVisit : kOtherVisit, there, pairs);
    }
  }
  return {pairs.begin(), pairs.end()};
}

/// Squared Mahalanobis distance between a measured and a predicted pose; the information of the
/// measurement may be singular: (L^-1 + P^-1)^-1 = L (L + P)^-1 P holds for it too.
double mahalanobis_squared(const Vector6d& difference, const Matrix6d& information,
                           const Matrix6d& covariance) {
  // A micrometre and a microradian keep directions that the space does not have invertible.
  const Matrix6d prediction = (covariance + 1e-12 * Matrix6d::Identity()).inverse();
  const Matrix6d both = information * (information + prediction).inverse() * prediction;
  return difference.dot(both * difference);
}

/// Clouds of one visit err alike against each other: they sample the same rough ground at the same
/// bearings, and their registrations in a row bend the way the same way. The tracker has matched
/// each of them with all the keyframes of its local map at once, of which the pair is one: it tells
/// as much again as its share, or the common error would outweigh an odometry that is held upright.
void share_visits(std::vector<Constraint>& found) {
  for (Constraint& c : found)
    if (c.b - c.a <= kVisitGap) c.information /= kLocalMapKeyframes;
}

/// Of a prior in the plane that decides nothing that the surfaces tell, and keeps a pose from
/// wandering along what they leave free: registration finds nothing that is farther off. In space
/// the little ground that is seen must hold against it, so there is none.
Matrix6d free_information(Space space) {
  constexpr double kFree_m = 0.3, kFree_rad = 0.1;
  Matrix6d information = Matrix6d::Zero();
  if (space == Space::se3) return information;
  for (const int axis : {0, 1}) information(axis, axis) = 1 / (kFree_m * kFree_m);
  information(5, 5) = 1 / (kFree_rad * kFree_rad);
  return information;
}

class PairRegistration {
 public:
  PairRegistration(Space space, std::span<const Keyframe> keyframes,
                   std::span<const Pose> T_world_keyframe, const graph::WeightedGraph& overlap,
                   const PairCovariance& covariance)
      : space_(space),
        keyframes_(keyframes),
        T_world_keyframe_(T_world_keyframe),
        overlap_(overlap),
        covariance_(covariance) {}

  std::optional<Constraint> operator()(int a, int b, const RegistrationTarget& target_a,
                                       const Surface& surface_b) const {
    const std::optional<Matrix6d> predicted = covariance_(a, b);
    if (!predicted) return std::nullopt;
    const Pose T_a_b = relative_pose(T_world_keyframe_[static_cast<size_t>(a)],
                                     T_world_keyframe_[static_cast<size_t>(b)]);
    RegistrationOptions options;
    options.space = space_;
    options.prior = PosePrior{T_a_b, free_information(space_)};
    const Registration result = register_surface(surface_b, target_a, T_a_b, options);
    if (result.termination != Registration::Termination::converged) return std::nullopt;
    // SSO = m / (|a| + |b| - m); for surfaces of like size the share of b that a explains is 2 SSO
    // / (1 + SSO).
    const double sso = overlap_.weight(a, b);
    if (result.inlier_fraction < kMinExplained * 2 * sso / (1 + sso)) return std::nullopt;
    const Vector6d difference = graph::boxminus(result.T_target_source, T_a_b);
    if (mahalanobis_squared(difference, result.information, *predicted) > kMaxMahalanobisSquared)
      return std::nullopt;
    return Constraint{a, b, ConstraintKind::registration, result.T_target_source,
                      result.information};
  }

 private:
  Space space_;
  std::span<const Keyframe> keyframes_;
  std::span<const Pose> T_world_keyframe_;
  const graph::WeightedGraph& overlap_;
  const PairCovariance& covariance_;
};

}  // namespace

std::vector<Constraint> register_overlapping(
    Space space, std::span<const Keyframe> keyframes, std::span<const Pose> T_world_keyframe,
    const graph::WeightedGraph& overlap, std::span<const Constraint> known,
    const PairCovariance& covariance, const ObservationStore& observations,
    const LocalConstraintOptions& options, const Run& run) {
  const std::vector<std::pair<int, int>> pairs =
      pairs_to_register(overlap, options.min_overlap, known);
  const SurfaceStore surfaces(observations, options.surface_cache_bytes);
  const auto surface_of = [&](int k) {
    return surfaces.load(keyframes[static_cast<size_t>(k)].observation);
  };
  const PairRegistration register_pair(space, keyframes, T_world_keyframe, overlap, covariance);
  std::vector<std::optional<Constraint>> slots(pairs.size());
  // One task a target keyframe: its pairs lie next to each other.
  std::vector<size_t> starts;
  for (size_t k = 0; k < pairs.size(); ++k)
    if (k == 0 || pairs[k].first != pairs[k - 1].first) starts.push_back(k);
  starts.push_back(pairs.size());
  std::atomic<size_t> done = 0;
  tbb::task_arena arena(run.threads);
  arena.execute([&] {
    tbb::parallel_for(size_t{0}, starts.size() - 1, [&](size_t s) {
      const auto surface_a = surface_of(pairs[starts[s]].first);
      const RegistrationTarget::Placed placed[] = {{Pose{}, surface_a.get()}};
      const RegistrationTarget target(placed);
      for (size_t k = starts[s]; k < starts[s + 1]; ++k)
        slots[k] =
            register_pair(pairs[k].first, pairs[k].second, target, *surface_of(pairs[k].second));
      done += starts[s + 1] - starts[s];
    });
  });
  std::vector<Constraint> constraints;
  for (const auto& slot : slots)
    if (slot) constraints.push_back(*slot);
  if (space == Space::se3) share_visits(constraints);
  return constraints;
}

}  // namespace hmt::submap
