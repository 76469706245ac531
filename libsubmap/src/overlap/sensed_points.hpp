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
  /// The points of one leaf: leaf g holds the points from g * kLeafSize on.
  struct Leaf {
    Eigen::Vector3f center;
    Eigen::Vector3f half;  ///< half the sides of the box of the points
    float radius_m = 0;    ///< half its diagonal
    float min_gate = 0;
    float max_gate = 0;
    int size = 0;
  };
  /// Neighbouring points of a surface, so close together against their gates that they often match
  /// one and the same point.
  static constexpr int kLeafSize = 4;

  SensedPoints() = default;
  /// Points that are not finite are left out.
  SensedPoints(const Reading& reading, const Pose& T_frame_robot, double max_mahalanobis);

  int size() const { return static_cast<int>(points_.size()); }
  std::span<const SensedPoint> points() const { return points_; }
  /// Empty where there are no points.
  std::span<const Node> nodes() const { return nodes_; }
  std::span<const Leaf> leaves() const { return leaves_; }
  /// The points of leaf g.
  std::span<const SensedPoint> leaf_points(int leaf) const;
  /// The points of a leaf node; nothing for an inner node.
  std::span<const SensedPoint> node_points(int node) const {
    return node < first_leaf_ ? std::span<const SensedPoint>{} : leaf_points(node - first_leaf_);
  }

 private:
  void sort_into_leaves(int begin_leaf, int end_leaf);
  void make_nodes(int leaves);
  void make_leaves(int leaves);

  std::vector<SensedPoint> points_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  int first_leaf_ = 0;  ///< index of the first leaf node
};

}  // namespace hmt::submap
