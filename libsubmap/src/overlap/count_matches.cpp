// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "count_matches.hpp"

#include <Eigen/LU>
#include <array>

namespace hmt::submap {
namespace {

/// One query against many targets. Gates are d^2 * variance, so all comparisons are of metres^2.
class Query {
 public:
  Query(const SensedPoint& point, const PoseSpread& spread, const OverlapOptions& options)
      : point_(point),
        spread_(spread),
        square_distance_(options.max_mahalanobis * options.max_mahalanobis) {
    const double trace = spread.trace(point.position.cast<double>());
    usable_ = trace <= options.max_pose_deviation_m * options.max_pose_deviation_m;
    reach_ = point.gate + static_cast<float>(square_distance_ * trace);
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
    const float square = epsilon.squaredNorm();
    // All eigenvalues of S lie between the points' own variance and that plus the spread's trace.
    if (square <= point_.gate + target.gate) return true;
    if (square > reach_ + target.gate) return false;
    if (!spread_is_known_) {
      spread_gate_ = square_distance_ * spread_.covariance(point_.position.cast<double>());
      spread_is_known_ = true;
    }
    Eigen::Matrix3d S = spread_gate_;
    S.diagonal().array() += static_cast<double>(point_.gate + target.gate);
    const Eigen::Vector3d e = epsilon.cast<double>();
    return e.dot(S.inverse() * e) <= 1;
  }

 private:
  const SensedPoint& point_;
  const PoseSpread& spread_;
  double square_distance_ = 0;
  bool usable_ = false;
  float reach_ = 0;
  bool spread_is_known_ = false;
  Eigen::Matrix3d spread_gate_;  ///< d^2 * covariance of the pose's displacement, once asked for
};

bool tree_has_match(Query& query, const SensedPoints& targets) {
  // A binary tree over at most 2^31 points is less than 32 deep; one sibling waits on each level.
  std::array<int, 64> waiting;
  size_t top = 0;
  waiting[top++] = 0;
  const int num_nodes = static_cast<int>(targets.nodes().size());
  while (top > 0) {
    const int node = waiting[--top];
    const SensedPoints::Node& n = targets.nodes()[static_cast<size_t>(node)];
    if (!query.can_match(n.box, n.gate)) continue;
    for (const SensedPoint& target : targets.node_points(node)) {
      if (query.matches(target)) return true;
    }
    if (2 * node + 2 >= num_nodes) continue;
    waiting[top++] = 2 * node + 2;
    waiting[top++] = 2 * node + 1;
  }
  return false;
}

const SensedPoint& target_at(const SensedPoints& targets, int index) {
  return targets.points()[static_cast<size_t>(index)];
}

bool has_match(Query& query, const SensedPoints& targets, const NearestGrid* grid) {
  if (!query.usable()) return false;
  if (grid != nullptr && query.reach() <= grid->max_reach()) {
    const NearestGrid::Cell& cell = grid->at(query.position());
    if (cell.bound > query.reach()) return false;
    if (query.matches(target_at(targets, cell.nearest))) return true;
  }
  return tree_has_match(query, targets);
}

enum class Verdict { all_match, none_matches, open };

/// Decides for the queries of a leaf at once where one target is within all their gates or none is
/// within any.
Verdict judge(const SensedPoints::Leaf& leaf, const SensedPoints& targets, const PoseSpread& spread,
              const OverlapOptions& options, const NearestGrid& grid) {
  if (leaf.radius_m > grid.margin_m()) return Verdict::open;
  const double deviation =
      spread.max_deviation(leaf.center.cast<double>(), static_cast<double>(leaf.radius_m));
  if (deviation > options.max_pose_deviation_m) return Verdict::open;
  const double pose_gate = options.max_mahalanobis * deviation;
  const float reach = leaf.max_gate + static_cast<float>(pose_gate * pose_gate);
  if (reach > grid.max_reach()) return Verdict::open;
  const NearestGrid::Cell& cell = grid.at(leaf.center);
  if (cell.bound > reach) return Verdict::none_matches;
  const SensedPoint& target = target_at(targets, cell.nearest);
  const Eigen::Vector3f farthest = (leaf.center - target.position).cwiseAbs() + leaf.half;
  return farthest.squaredNorm() <= leaf.min_gate + target.gate ? Verdict::all_match : Verdict::open;
}

}  // namespace

int count_matches(const SensedPoints& queries, const SensedPoints& targets,
                  const PoseSpread& spread, const OverlapOptions& options,
                  const NearestGrid* grid) {
  if (targets.size() == 0) return 0;
  int count = 0;
  for (int i = 0; i < static_cast<int>(queries.leaves().size()); ++i) {
    const SensedPoints::Leaf& leaf = queries.leaves()[static_cast<size_t>(i)];
    const Verdict verdict =
        grid != nullptr ? judge(leaf, targets, spread, options, *grid) : Verdict::open;
    if (verdict == Verdict::all_match) count += leaf.size;
    if (verdict != Verdict::open) continue;
    for (const SensedPoint& point : queries.leaf_points(i)) {
      Query query(point, spread, options);
      if (has_match(query, targets, grid)) ++count;
    }
  }
  return count;
}

}  // namespace hmt::submap
