// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "count_matches.hpp"

#include <Eigen/LU>
#include <array>

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

bool tree_has_match(Query& query, const SensedPoints& targets) {
  // Halved by number the tree is less than 32 deep, below that less than 32 more: one sibling waits
  // on each level.
  std::array<int, 64> waiting;
  size_t top = 0;
  waiting[top++] = 0;
  while (top > 0) {
    const int node = waiting[--top];
    const SensedPoints::Node& n = targets.nodes()[static_cast<size_t>(node)];
    if (!query.can_match(n.box, n.gate)) continue;
    if (n.second != 0) {
      waiting[top++] = n.second;
      waiting[top++] = node + 1;
      continue;
    }
    for (const SensedPoint& target : targets.points(n.begin, n.end)) {
      if (query.matches(target)) return true;
    }
  }
  return false;
}

const SensedPoint& target_at(const SensedPoints& targets, int index) {
  return targets.points()[static_cast<size_t>(index)];
}

bool has_match(Query& query, const SensedPoints& targets, const NearestGrid* grid) {
  if (!query.usable()) return false;
  if (grid != nullptr) {
    if (grid->bound({query.position(), query.position()}) > query.reach()) return false;
    const int nearest = grid->nearest(query.position());
    if (nearest >= 0 && query.matches(target_at(targets, nearest))) return true;
  }
  return tree_has_match(query, targets);
}

enum class Verdict { all_match, none_matches, open };

/// Decides for the queries of a leaf at once where one target is within all their gates or none is
/// within any. `max_pose_gate`: d^2 times the mean square displacement of any usable query.
Verdict judge(const SensedPoints::Leaf& leaf, const SensedPoints& targets, const PairGate& pair,
              float max_pose_gate, const NearestGrid& grid) {
  const float bound = grid.bound(leaf.box);
  if (bound > leaf.max_gate + max_pose_gate) return Verdict::none_matches;
  const Eigen::Vector3f center = leaf.box.center();
  const float square_deviation = pair.spread.max_trace(center, leaf.radius_m);
  if (bound > leaf.max_gate + pair.reach(square_deviation)) return Verdict::none_matches;
  if (square_deviation > pair.max_square_deviation_f) return Verdict::open;
  const int nearest = grid.nearest(center);
  if (nearest < 0) return Verdict::open;
  const SensedPoint& target = target_at(targets, nearest);
  const Eigen::Vector3f farthest =
      (target.position - leaf.box.min()).cwiseMax(leaf.box.max() - target.position);
  return pair.surely_matches(farthest, leaf.min_gate + target.gate) ? Verdict::all_match
                                                                    : Verdict::open;
}

float max_pose_gate(const SensedPoints& queries, const PairGate& pair) {
  const Eigen::AlignedBox3f& box = queries.nodes().front().box;
  const float square_deviation = pair.spread.max_trace(box.center(), box.sizes().norm() / 2);
  return pair.reach(std::min(pair.max_square_deviation_f, square_deviation));
}

}  // namespace

int count_matches(const SensedPoints& queries, const SensedPoints& targets,
                  const PoseSpread& spread, const OverlapOptions& options,
                  const NearestGrid* grid) {
  if (targets.size() == 0 || queries.size() == 0) return 0;
  const PairGate pair(spread, options);
  const float widest = max_pose_gate(queries, pair);
  int count = 0;
  for (const SensedPoints::Group& group : queries.groups()) {
    if (grid != nullptr && grid->coarse_bound(group.box) > group.gate + widest) continue;
    for (const SensedPoints::Leaf& leaf : queries.leaves(group)) {
      const Verdict verdict =
          grid != nullptr ? judge(leaf, targets, pair, widest, *grid) : Verdict::open;
      if (verdict == Verdict::all_match) count += leaf.end - leaf.begin;
      if (verdict != Verdict::open) continue;
      for (const SensedPoint& point : queries.points(leaf.begin, leaf.end)) {
        Query query(point, pair);
        if (has_match(query, targets, grid)) ++count;
      }
    }
  }
  return count;
}

}  // namespace hmt::submap
