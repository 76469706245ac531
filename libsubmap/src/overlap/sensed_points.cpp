// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sensed_points.hpp"

#include <algorithm>
#include <bit>

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
  const int used_leaves = (size() + kLeafSize - 1) / kLeafSize;
  const int leaves = static_cast<int>(std::bit_ceil(static_cast<unsigned>(used_leaves)));
  sort_into_leaves(0, leaves);
  make_nodes(leaves);
  make_leaves(used_leaves);
}

void SensedPoints::make_nodes(int leaves) {
  first_leaf_ = leaves - 1;
  nodes_.resize(static_cast<size_t>(2 * leaves - 1));
  for (int node = 2 * leaves - 2; node >= 0; --node) {
    Node& n = nodes_[static_cast<size_t>(node)];
    for (const SensedPoint& p : node_points(node)) {
      n.box.extend(p.position);
      n.gate = std::max(n.gate, p.gate);
    }
    if (node >= first_leaf_) continue;
    for (const int child : {2 * node + 1, 2 * node + 2}) {
      n.box.extend(nodes_[static_cast<size_t>(child)].box);
      n.gate = std::max(n.gate, nodes_[static_cast<size_t>(child)].gate);
    }
  }
}

void SensedPoints::make_leaves(int leaves) {
  leaves_.reserve(static_cast<size_t>(leaves));
  for (int i = 0; i < leaves; ++i) {
    const Node& node = nodes_[static_cast<size_t>(first_leaf_ + i)];
    Leaf leaf{node.box.center(), node.box.sizes() / 2, 0, node.gate, node.gate, 0};
    leaf.radius_m = leaf.half.norm();
    for (const SensedPoint& p : leaf_points(i)) leaf.min_gate = std::min(leaf.min_gate, p.gate);
    leaf.size = static_cast<int>(leaf_points(i).size());
    leaves_.push_back(leaf);
  }
}

std::span<const SensedPoint> SensedPoints::leaf_points(int leaf) const {
  const auto begin = std::min(points_.size(), static_cast<size_t>(leaf) * kLeafSize);
  return std::span(points_).subspan(begin, std::min<size_t>(kLeafSize, points_.size() - begin));
}

void SensedPoints::sort_into_leaves(int begin_leaf, int end_leaf) {
  if (end_leaf - begin_leaf < 2) return;
  const int middle_leaf = (begin_leaf + end_leaf) / 2;
  const auto at = [this](int leaf) {
    return points_.begin() + std::min<std::ptrdiff_t>(size(), std::ptrdiff_t{leaf} * kLeafSize);
  };
  const auto begin = at(begin_leaf), middle = at(middle_leaf), end = at(end_leaf);
  Eigen::AlignedBox3f box;
  std::for_each(begin, end, [&box](const SensedPoint& p) { box.extend(p.position); });
  Eigen::Index axis = 0;
  if (begin != end) box.sizes().maxCoeff(&axis);
  if (middle != end) {
    std::nth_element(begin, middle, end, [axis](const SensedPoint& a, const SensedPoint& b) {
      return a.position[axis] < b.position[axis];
    });
  }
  sort_into_leaves(begin_leaf, middle_leaf);
  sort_into_leaves(middle_leaf, end_leaf);
}

}  // namespace hmt::submap
