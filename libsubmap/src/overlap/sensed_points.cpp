// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sensed_points.hpp"

#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

// Standard deviation of a measured point besides the discrete sampling: makers state an accuracy of
// +-15 mm (SICK LMS 200) to +-20 mm (Velodyne HDL-32E). The angle of a beam is known much better
// than the step between beams, so sigma_f covers it and this part is taken as isotropic.
constexpr double kPointSigma_m = 0.02;

/// Sigma_s + sigma_f^2 I of Eq. 16 with sigma_f = r beta; both are multiples of the identity.
double point_variance(double range_m, double beam_step_rad) {
  const double sigma_f = range_m * beam_step_rad;
  return kPointSigma_m * kPointSigma_m + sigma_f * sigma_f;
}

// A leaf has at most so many points, ...
constexpr int kLeafSize = 12;
// ... no farther from its middle than this share of the root of their least gate.
constexpr float kLeafRadius = 0.8F;
// The leaves of so many points at most make a group: a few decimetres of a wall.
constexpr int kGroupSize = 24;
// Nodes of more points are halved by number, so that the tree stays flat; smaller ones in the
// middle of their box, so that no leaf reaches across a gap.
constexpr int kHalvedByNumber = 32;

SensedPoints::Leaf leaf_of(const SensedPoints::Node& node, std::span<const SensedPoint> points) {
  SensedPoints::Leaf leaf{node.box, node.box.sizes().norm() / 2, node.gate, node.gate, node.begin,
                          node.end};
  for (const SensedPoint& p : points) leaf.min_gate = std::min(leaf.min_gate, p.gate);
  return leaf;
}

bool is_small(const SensedPoints::Leaf& leaf) {
  const int size = leaf.end - leaf.begin;
  return leaf.radius_m == 0 ||
         (size <= kLeafSize && leaf.radius_m <= kLeafRadius * std::sqrt(leaf.min_gate));
}

}  // namespace

SensedPoints::SensedPoints(const Reading& reading, const Pose& T_frame_robot,
                           double max_mahalanobis) {
  const Pose T_frame_sensor = T_frame_robot * reading.T_robot_sensor;
  const Eigen::Matrix3d R = T_frame_sensor.rotation_matrix();
  points_.reserve(reading.points_sensor.size());
  for (const Eigen::Vector3f& p : reading.points_sensor) {
    if (!p.allFinite()) continue;
    const Eigen::Vector3d p_sensor = p.cast<double>();
    const double variance = point_variance(p_sensor.norm(), reading.beam_step_rad);
    points_.push_back({(T_frame_sensor.translation + R * p_sensor).cast<float>(),
                       static_cast<float>(max_mahalanobis * max_mahalanobis * variance)});
  }
  if (points_.empty()) return;
  make_nodes(0, size(), false);
}

void SensedPoints::make_nodes(int begin, int end, bool is_grouped) {
  Node node{{}, 0, begin, end, 0};
  for (const SensedPoint& p : points(begin, end)) {
    node.box.extend(p.position);
    node.gate = std::max(node.gate, p.gate);
  }
  const size_t at = nodes_.size();
  nodes_.push_back(node);
  const Leaf leaf = leaf_of(node, points(begin, end));
  const bool is_group = !is_grouped && (is_small(leaf) || end - begin <= kGroupSize);
  if (is_group)
    groups_.push_back({node.box, leaf.radius_m, node.gate, static_cast<int>(leaves_.size()), 0});
  if (is_small(leaf)) {
    leaves_.push_back(leaf);
  } else {
    const int middle = split(node);
    make_nodes(begin, middle, is_grouped || is_group);
    nodes_[at].second = static_cast<int>(nodes_.size());
    make_nodes(middle, end, is_grouped || is_group);
  }
  if (is_group) groups_.back().end_leaf = static_cast<int>(leaves_.size());
}

int SensedPoints::split(const Node& node) {
  const auto begin = points_.begin() + node.begin, end = points_.begin() + node.end;
  Eigen::Index axis = 0;
  node.box.sizes().maxCoeff(&axis);
  if (node.end - node.begin > kHalvedByNumber) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [axis](const SensedPoint& a, const SensedPoint& b) {
      return a.position[axis] < b.position[axis];
    });
    return static_cast<int>(middle - points_.begin());
  }
  // Both sides have a point: that of the box's maximum is above, that of its minimum is not, unless
  // rounding puts the middle on the maximum.
  const float middle =
      std::min(node.box.center()[axis], std::nextafter(node.box.max()[axis], node.box.min()[axis]));
  const auto above = std::partition(
      begin, end, [axis, middle](const SensedPoint& p) { return p.position[axis] <= middle; });
  return static_cast<int>(above - points_.begin());
}

}  // namespace hmt::submap
