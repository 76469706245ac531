// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "start_poses.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "chordal_relaxation.hpp"
#include "pose_problem.hpp"
#include "spanning_tree.hpp"

namespace hmt::graph {
namespace {

Start start_at(const PoseGraph& graph, Initialization kind, std::vector<Pose> poses,
               const Chi2OfPlacement& chi2_of) {
  Start start{kind, std::move(poses), {}, 0};
  start.points = kind == Initialization::given ? graph.points : place_points(graph, start.poses);
  start.chi2 = chi2_of({start.poses, start.points});
  return start;
}

Start make_start(const PoseGraph& graph, Initialization kind, const Chi2OfPlacement& chi2_of) {
  std::optional<std::vector<Pose>> poses;
  if (kind == Initialization::chordal) poses = chordal_poses(graph);
  if (kind == Initialization::spanning_tree) poses = spanning_tree_poses(graph, held_nodes(graph));
  if (!poses) return start_at(graph, Initialization::given, graph.poses, chi2_of);
  return start_at(graph, kind, std::move(*poses), chi2_of);
}

}  // namespace

std::vector<Eigen::Vector3d> place_points(const PoseGraph& graph, const std::vector<Pose>& poses) {
  std::vector<Eigen::Matrix3d> information(graph.points.size(), Eigen::Matrix3d::Zero());
  std::vector<Eigen::Vector3d> weighted(graph.points.size(), Eigen::Vector3d::Zero());
  for (const PointEdge& edge : graph.point_edges) {
    const Pose& T_world_node = poses[static_cast<size_t>(edge.node)];
    const Eigen::Matrix3d R = T_world_node.rotation_matrix();
    const Eigen::Matrix3d in_world = R * edge.information * R.transpose();
    const auto point = static_cast<size_t>(edge.point);
    information[point] += in_world;
    weighted[point] += in_world * (T_world_node * edge.p_node);
  }
  std::vector<Eigen::Vector3d> points = graph.points;
  for (size_t k = 0; k < points.size(); ++k) {
    if (graph.space == Space::se2) {
      const Eigen::LLT<Eigen::Matrix2d> llt(information[k].topLeftCorner<2, 2>());
      if (llt.info() == Eigen::Success) points[k].head<2>() = llt.solve(weighted[k].head<2>());
    } else if (const Eigen::LLT<Eigen::Matrix3d> llt(information[k]);
               llt.info() == Eigen::Success) {
      points[k] = llt.solve(weighted[k]);
    }
  }
  return points;
}

std::vector<Start> choose_starts(const PoseGraph& graph, Initialization wanted, int restarts,
                                 const Chi2OfPlacement& chi2_of) {
  std::vector<Start> starts;
  const bool all = wanted == Initialization::best || restarts > 0;
  if (wanted != Initialization::best) starts.push_back(make_start(graph, wanted, chi2_of));
  for (const Initialization kind :
       {Initialization::chordal, Initialization::given, Initialization::spanning_tree})
    if (all && kind != wanted) starts.push_back(make_start(graph, kind, chi2_of));
  if (wanted == Initialization::best) {
    // A chi2 that is not a number loses.
    const auto less = [](const Start& a, const Start& b) {
      return a.chi2 < b.chi2 || (b.chi2 != b.chi2 && a.chi2 == a.chi2);
    };
    std::stable_sort(starts.begin(), starts.end(), less);
  }
  const auto count = static_cast<size_t>(restarts) + 1;
  for (unsigned seed = 1; starts.size() < count; ++seed)
    starts.push_back(
        start_at(graph, Initialization::random_tree, random_tree_poses(graph, seed), chi2_of));
  starts.resize(count);
  return starts;
}

Start initial_poses(const PoseGraph& graph, Initialization wanted) {
  check_pose_graph(graph);
  const auto chi2_of = [&](const Placement& placement) {
    const std::vector<double> chi2 = factor_chi2(graph, placement);
    return std::accumulate(chi2.begin(), chi2.end(), 0.0);
  };
  return choose_starts(graph, wanted, 0, chi2_of).front();
}

}  // namespace hmt::graph
