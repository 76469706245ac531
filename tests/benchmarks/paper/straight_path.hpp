// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <numbers>
#include <vector>

#include "hmt/graph/partition.hpp"
#include "hmt/graph/weighted_graph.hpp"

namespace hmt::paper {

/// The simulation of [Blanco 2009, Sec. 6.1]. The paper gives the first two numbers; all others
/// are choices.
struct StraightPathParameters {
  double length_m = 50;
  int landmarks = 60;
  double half_width_m = 7.5;  ///< landmarks lie in [0, length] x [-half_width, half_width]
  double step_m = 0.05;       ///< path between two observations
  double max_range_m = 12;
  double field_of_view_rad = 65 * std::numbers::pi / 180;  ///< that of the paper's stereo camera
  double sigma_range_m = 0.05;
  double sigma_bearing_rad = std::numbers::pi / 180;
  /// Odometry, after one metre; grows with the square root of the path.
  double sigma_odometry_m = 0.01;
  double sigma_odometry_rad = 0.2 * std::numbers::pi / 180;
  /// The robot's last pose is taken out of the filter before its information matrix is looked at.
  bool marginalize_pose = false;
  /// Overlap by the identity of the landmarks instead of Eq. 15.
  bool known_landmarks = false;
};

/// One run of the filter along the path.
struct StraightPathRun {
  std::vector<Eigen::Vector3d> poses;  ///< the filter's (x, y, yaw) at each observation
  std::vector<std::vector<int>> seen;  ///< landmarks of each observation, increasing
  std::vector<int> state_landmarks;    ///< landmarks in the order of the filter's state
  Eigen::VectorXd state;               ///< pose and landmarks at the end, as the filter has them
  Eigen::MatrixXd covariance;          ///< of `state`
  Eigen::MatrixXd information;         ///< |H(i, j)| of Eq. 22: norms of 2x2 blocks
  graph::WeightedGraph overlap;        ///< of the observations
};

StraightPathRun run_straight_path(const StraightPathParameters& parameters, uint64_t seed);

/// e of Eq. 22 for a partition of the observations: the share of the information between landmarks
/// that no submap has in common.
double landmark_information_loss(const StraightPathRun& run, const graph::Labels& labels);

}  // namespace hmt::paper
