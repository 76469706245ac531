// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "hmt/graph/pose_graph.hpp"

namespace hmt::graph {

/// How edges that contradict the others are treated.
enum class RobustMethod {
  none,   ///< every edge counts with its square
  huber,  ///< linear growth beyond the 95 % quantile of chi2
  gnc     ///< graduated non-convexity, truncated least squares [Yang 2020]: an edge is in or out
};

/// Where the optimization starts.
enum class Initialization {
  given,          ///< the poses of the graph
  chordal,        ///< chordal relaxation of the rotations, then translations [Carlone 2015]
  spanning_tree,  ///< edges chained along a breadth-first tree from the gauge
  best,           ///< the one of least chi2 among these three
  random_tree     ///< edges chained along a random spanning tree; only for restarts
};

struct PoseOptimizerOptions {
  RobustMethod robust = RobustMethod::none;
  Initialization initialization = Initialization::given;
  /// Upper limit of the iterations of one solve, >= 1.
  int max_iterations = 100;
  /// With gnc: edges that are never doubted (odometry), one flag an edge; empty: edges between i
  /// and i+1, if they join at least half of the nodes to the one before.
  std::vector<bool> trusted;
  /// With gnc: the same for point edges; empty: all of them are doubted.
  std::vector<bool> trusted_points;
  /// Further starts, >= 0: the other ones of Initialization, then random spanning trees. Each is
  /// solved and the least cost is kept.
  int restarts = 0;
  /// Starts that are solved at the same time, >= 1; a single solve runs on one.
  int threads = 1;
};

enum class Termination { converged, iteration_limit, nothing_to_do, failed };

/// One start and where it led.
struct StartReport {
  Initialization start = Initialization::given;
  double chi2_start = 0;  ///< over all edges
  double cost = 0;        ///< of the result, see PoseOptimizerReport
  Termination termination = Termination::nothing_to_do;
};

struct PoseOptimizerReport {
  Termination termination = Termination::nothing_to_do;
  std::string message;
  int iterations = 0;
  double chi2_initial = 0;  ///< sum of r^T Omega r over all edges as given, no 1/2
  double chi2 = 0;          ///< the same at the result; with gnc, over the inliers
  /// What was minimized: the sum over edges of r^T Omega r, of its Huber loss, or of its
  /// truncation.
  double cost = 0;
  /// Largest component of the gradient of cost / 2 at the result, in the scale of the solver's
  /// parameters (metres, radians).
  double gradient_norm = 0;
  /// Expectation of chi2 if the information is right: measured numbers of the inliers less free
  /// numbers of the poses.
  double degrees_of_freedom = 0;
  double solve_s = 0;  ///< initialization and optimization
  std::vector<StartReport> starts;
  Initialization start = Initialization::given;  ///< the start that was taken
  std::vector<double> edge_chi2;                 ///< r^T Omega r of every edge at the result
  std::vector<bool> inlier;                      ///< verdict on every edge; all true without gnc
  std::vector<double> point_chi2;                ///< the same of every point edge
  std::vector<bool> point_inlier;
  /// With gnc: the trusted edges do not determine all poses, so what joins them is a guess that was
  /// checked. The verdict is sound where a few trusted drives are to be joined, and weak where no
  /// edge is trusted.
  bool untrusted_start = false;
};

struct PoseOptimizerResult {
  std::vector<Pose> poses;
  std::vector<Eigen::Vector3d> points;
  PoseOptimizerReport report;
};

/// Minimizes the sum of r^T Omega r over the poses and points, r = boxminus(T_world_from^-1
/// T_world_to, T_from_to): in the plane r = (R_z^T (t_rel - t_z), wrap(yaw)), in space r = (R_z^T
/// (t_rel - t_z), 2 vec(q_z^-1 q_rel)) with q_w >= 0; of a point edge r = R_node^T (p - t_node) -
/// p_node. In Space::se2 the z of points stays as it is. Deterministic for any number of threads. A
/// graph without edges returns its poses. Throws InputError naming the edge whose nodes or numbers
/// are invalid.
PoseOptimizerResult optimize(const PoseGraph& graph, const PoseOptimizerOptions& options);

}  // namespace hmt::graph
