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

/// The points of a reading, prepared for matching: in the common frame, with their gates, in a tree
/// of boxes.
class SensedPoints {
 public:
  /// A box of points with the largest of their gates. The first child follows its parent.
  struct Node {
    Eigen::AlignedBox3f box;
    float gate = 0;
    int begin = 0;  ///< its points
    int end = 0;
    int second = 0;  ///< the second child; 0 for a leaf
  };
  /// The points of a leaf node: neighbours on a surface, so close together against their gates that
  /// they often match one and the same point.
  struct Leaf {
    Eigen::AlignedBox3f box;
    float radius_m = 0;  ///< half its diagonal
    float min_gate = 0;
    float max_gate = 0;
    int begin = 0;
    int end = 0;
  };

  /// Leaves that lie together: those from begin_leaf to end_leaf - 1.
  struct Group {
    Eigen::AlignedBox3f box;
    float radius_m = 0;  ///< half its diagonal
    float gate = 0;      ///< the largest of theirs
    int begin_leaf = 0;
    int end_leaf = 0;
  };

  SensedPoints() = default;
  /// Points that are not finite are left out.
  SensedPoints(const Reading& reading, const Pose& T_frame_robot, double max_mahalanobis);

  int size() const { return static_cast<int>(points_.size()); }
  std::span<const SensedPoint> points() const { return points_; }
  std::span<const SensedPoint> points(int begin, int end) const {
    return points().subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin));
  }
  /// Empty where there are no points; the first is the root.
  std::span<const Node> nodes() const { return nodes_; }
  std::span<const Leaf> leaves() const { return leaves_; }
  /// All leaves, in their order.
  std::span<const Group> groups() const { return groups_; }
  std::span<const Leaf> leaves(const Group& group) const {
    return leaves().subspan(static_cast<size_t>(group.begin_leaf),
                            static_cast<size_t>(group.end_leaf - group.begin_leaf));
  }

 private:
  void make_nodes(int begin, int end, bool is_grouped);
  int split(const Node& node);

  std::vector<SensedPoint> points_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::vector<Group> groups_;
};

}  // namespace hmt::submap
