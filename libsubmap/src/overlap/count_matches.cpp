// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "count_matches.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace hmt::submap {
namespace {

/// What all queries of one pair of readings have in common. Gates are d^2 * variance, so all
/// comparisons are of metres^2.
struct PairGate {
  const PoseSpread& spread;
  double square_distance = 0;       ///< d^2
  double max_square_deviation = 0;  ///< of a displacement by the pose, metres^2
  float square_distance_f = 0, max_square_deviation_f = 0;  ///< the same in float
  float plane_floor = 0;   ///< the spread adds so much to a gate everywhere, in x and y
  float height_floor = 0;  ///< and along z
  float smaller_floors = 0;

  PairGate(const PoseSpread& pose_spread, const OverlapOptions& options)
      : spread(pose_spread),
        square_distance(options.max_mahalanobis * options.max_mahalanobis),
        max_square_deviation(options.max_pose_deviation_m * options.max_pose_deviation_m),
        square_distance_f(static_cast<float>(square_distance)),
        max_square_deviation_f(static_cast<float>(max_square_deviation)),
        plane_floor(static_cast<float>(square_distance * spread.floor().plane)),
        height_floor(static_cast<float>(square_distance * spread.floor().height)),
        smaller_floors(static_cast<float>(square_distance * spread.floor().smaller_two())) {}

  /// The most that a spread of so large a trace adds to a gate in any direction.
  float reach(float trace) const { return square_distance_f * trace - smaller_floors; }
  /// True for a difference that is within the gate by the least that the spread adds. `gate`: of
  /// both points.
  bool surely_matches(const Eigen::Vector3f& epsilon, float gate) const {
    const float plane = gate + plane_floor, height = gate + height_floor;
    const float square_plane = epsilon.x() * epsilon.x() + epsilon.y() * epsilon.y();
    return square_plane * height + epsilon.z() * epsilon.z() * plane <= plane * height;
  }
};

/// One query against many targets.
class Query {
 public:
  Query(const SensedPoint& point, const PairGate& pair) : point_(point), pair_(pair) {
    const double trace = pair.spread.trace(point.position.cast<double>());
    usable_ = trace <= pair.max_square_deviation;
    reach_ = point.gate + pair.reach(static_cast<float>(trace));
  }

  /// False where the pose is too uncertain to tell.
  bool usable() const { return usable_; }
  const Eigen::Vector3f& position() const { return point_.position; }
  float reach() const { return reach_; }

  /// Whether a target in the box, with a gate of at most `gate`, can match.
  bool can_match(const Eigen::AlignedBox3f& box, float gate) const {
    return box.squaredExteriorDistance(point_.position) <= reach_ + gate;
  }

  bool matches(const SensedPoint& target) {
    const Eigen::Vector3f epsilon = target.position - point_.position;
    // The reach bounds the largest eigenvalue of S.
    if (epsilon.squaredNorm() > reach_ + target.gate) return false;
    if (pair_.surely_matches(epsilon, point_.gate + target.gate)) return true;
    if (!spread_is_known_) {
      spread_gate_ =
          pair_.square_distance * pair_.spread.covariance(point_.position.cast<double>());
      spread_is_known_ = true;
    }
    Eigen::Matrix3d S = spread_gate_;
    S.diagonal().array() += static_cast<double>(point_.gate + target.gate);
    const Eigen::Vector3d e = epsilon.cast<double>();
    return e.dot(S.inverse() * e) <= 1;
  }

 private:
  const SensedPoint& point_;
  const PairGate& pair_;
  bool usable_ = false;
  float reach_ = 0;
  bool spread_is_known_ = false;
  Eigen::Matrix3d spread_gate_;  ///< d^2 * covariance of the pose's displacement, once asked for
};

/// The queries of a box: how far they reach, for all of them at once.
struct Region {
  const Eigen::AlignedBox3f& box;
  float square_deviation = 0;  ///< of a displacement by the pose, at most
  float reach = 0;             ///< of any usable query, at most

  Region(const Eigen::AlignedBox3f& queries, float radius_m, float gate, const PairGate& pair)
      : box(queries),
        square_deviation(pair.spread.max_trace(queries.center(), radius_m)),
        reach(gate + pair.reach(std::min(square_deviation, pair.max_square_deviation_f))) {}
};

using Nodes = std::vector<const SensedPoints::Node*>;

/// The leaves of the tree that the queries can match a target in.
void find_near(const Region& queries, const SensedPoints& targets, Nodes& leaves) {
  leaves.clear();
  // Halved by number the tree is less than 32 deep, below that less than 32 more: one sibling waits
  // on each level.
  std::array<int, 64> waiting;
  size_t top = 0;
  waiting[top++] = 0;
  while (top > 0) {
    const int node = waiting[--top];
    const SensedPoints::Node& n = targets.nodes()[static_cast<size_t>(node)];
    if (n.box.squaredExteriorDistance(queries.box) > queries.reach + n.gate) continue;
    if (n.second == 0) {
      leaves.push_back(&n);
      continue;
    }
    waiting[top++] = n.second;
    waiting[top++] = node + 1;
  }
}

const SensedPoint& target_at(const SensedPoints& targets, int index) {
  return targets.points()[static_cast<size_t>(index)];
}

bool has_match(Query& query, const SensedPoints& targets, const Nodes& near) {
  for (const SensedPoints::Node* leaf : near) {
    if (!query.can_match(leaf->box, leaf->gate)) continue;
    for (const SensedPoint& target : targets.points(leaf->begin, leaf->end)) {
      if (query.matches(target)) return true;
    }
  }
  return false;
}

enum class Verdict { all_match, none_matches, open };

/// Decides for the queries of a leaf at once where one target is within all their gates or none is
/// within any.
Verdict judge(const SensedPoints::Leaf& leaf, const Region& queries, const SensedPoints& targets,
              const PairGate& pair, const NearestGrid& grid) {
  const int nearest = grid.at(leaf.box.center()).nearest;
  if (nearest >= 0 && queries.square_deviation <= pair.max_square_deviation_f) {
    const SensedPoint& target = target_at(targets, nearest);
    const Eigen::Vector3f farthest =
        (target.position - leaf.box.min()).cwiseMax(leaf.box.max() - target.position);
    if (pair.surely_matches(farthest, leaf.min_gate + target.gate)) return Verdict::all_match;
  }
  return grid.can_reach(leaf.box, queries.reach) ? Verdict::open : Verdict::none_matches;
}

/// Counts the queries of one leaf that match, one by one.
int count_one_by_one(std::span<const SensedPoint> points, const Region& region,
                     const SensedPoints& targets, const PairGate& pair, const NearestGrid* grid,
                     Nodes& near) {
  int count = 0;
  bool is_known = false;
  for (const SensedPoint& point : points) {
    Query query(point, pair);
    if (!query.usable()) continue;
    if (grid != nullptr) {
      const NearestGrid::Place place = grid->at(query.position());
      if (place.bound > query.reach()) continue;
      if (place.nearest >= 0 && query.matches(target_at(targets, place.nearest))) {
        ++count;
        continue;
      }
    }
    if (!is_known) find_near(region, targets, near);
    is_known = true;
    if (has_match(query, targets, near)) ++count;
  }
  return count;
}

}  // namespace

int count_matches(const SensedPoints& queries, const SensedPoints& targets,
                  const PoseSpread& spread, const OverlapOptions& options,
                  const NearestGrid* grid) {
  if (targets.size() == 0 || queries.size() == 0) return 0;
  const PairGate pair(spread, options);
  Nodes near;
  near.reserve(targets.leaves().size());
  int count = 0;
  for (const SensedPoints::Group& group : queries.groups()) {
    if (grid != nullptr &&
        !grid->can_reach(group.box, Region(group.box, group.radius_m, group.gate, pair).reach)) {
      continue;
    }
    for (const SensedPoints::Leaf& leaf : queries.leaves(group)) {
      const Region region(leaf.box, leaf.radius_m, leaf.max_gate, pair);
      const Verdict verdict =
          grid != nullptr ? judge(leaf, region, targets, pair, *grid) : Verdict::open;
      if (verdict == Verdict::all_match) count += leaf.end - leaf.begin;
      if (verdict != Verdict::open) continue;
      count +=
          count_one_by_one(queries.points(leaf.begin, leaf.end), region, targets, pair, grid, near);
    }
  }
  return count;
}

}  // namespace hmt::submap
