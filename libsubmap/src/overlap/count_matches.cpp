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

  /// Whether a target in the box, with a gate of at most `gate`, can match.
  bool can_match(const Eigen::AlignedBox3f& box, float gate) const {
    return box.squaredExteriorDistance(point_.position) <= reach_ + gate;
  }

  bool matches(const SensedPoint& target) const {
    const Eigen::Vector3f epsilon = target.position - point_.position;
    const float square = epsilon.squaredNorm();
    // All eigenvalues of S lie between the points' own variance and that plus the spread's trace.
    if (square <= point_.gate + target.gate) return true;
    if (square > reach_ + target.gate) return false;
    Eigen::Matrix3d S = square_distance_ * spread_.covariance(point_.position.cast<double>());
    S.diagonal().array() += point_.gate + target.gate;
    const Eigen::Vector3d e = epsilon.cast<double>();
    return e.dot(S.inverse() * e) <= 1;
  }

 private:
  const SensedPoint& point_;
  const PoseSpread& spread_;
  double square_distance_ = 0;
  bool usable_ = false;
  float reach_ = 0;
};

bool has_match(const Query& query, const SensedPoints& targets) {
  // A binary tree over at most 2^31 points is less than 32 deep; one sibling waits on each level.
  std::array<int, 64> waiting;
  size_t top = 0;
  waiting[top++] = 0;
  const int num_nodes = static_cast<int>(targets.nodes().size());
  while (top > 0) {
    const int node = waiting[--top];
    const SensedPoints::Node& n = targets.nodes()[static_cast<size_t>(node)];
    if (!query.can_match(n.box, n.gate)) continue;
    for (const SensedPoint& target : targets.leaf(node)) {
      if (query.matches(target)) return true;
    }
    if (2 * node + 2 >= num_nodes) continue;
    waiting[top++] = 2 * node + 2;
    waiting[top++] = 2 * node + 1;
  }
  return false;
}

}  // namespace

int count_matches(const SensedPoints& queries, const SensedPoints& targets,
                  const PoseSpread& spread, const OverlapOptions& options) {
  if (targets.size() == 0) return 0;
  int count = 0;
  for (const SensedPoint& point : queries.points()) {
    const Query query(point, spread, options);
    if (query.usable() && has_match(query, targets)) ++count;
  }
  return count;
}

}  // namespace hmt::submap
