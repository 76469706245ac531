// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// A point of a reading in the frame that two readings are compared in.
struct SensedPoint {
  Eigen::Vector3f position;
  /// d^2 * variance, metres^2, where d is the largest Mahalanobis distance of a correspondence and
  /// the variance is that of the measurement and of the discrete sampling [Blanco 2009, Eq. 16].
  float gate = 0;
};

/// The points of a reading, prepared for matching: in the common frame, with their gates, in a
/// balanced tree of boxes.
class SensedPoints {
 public:
  /// A box of points with the largest of their gates; children of node i are 2i + 1 and 2i + 2.
  struct Node {
    Eigen::AlignedBox3f box;
    float gate = 0;
  };
  /// Points of one leaf; small enough to be scanned at once.
  static constexpr int kLeafSize = 8;

  SensedPoints() = default;
  /// Points that are not finite are left out.
  SensedPoints(const Reading& reading, const Pose& T_frame_robot, double max_mahalanobis);

  int size() const { return static_cast<int>(points_.size()); }
  std::span<const SensedPoint> points() const { return points_; }
  /// Empty where there are no points.
  std::span<const Node> nodes() const { return nodes_; }
  const Eigen::AlignedBox3f& box() const { return nodes_.front().box; }
  float max_gate() const { return nodes_.front().gate; }
  /// The points of a leaf node; nothing for an inner node.
  std::span<const SensedPoint> leaf(int node) const;

 private:
  void sort_into_leaves(int begin_leaf, int end_leaf);

  std::vector<SensedPoint> points_;
  std::vector<Node> nodes_;
  int first_leaf_ = 0;  ///< index of the first leaf node
};

}  // namespace hmt::submap
