// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Loops replaced by false ones: does graduated non-convexity find them, and the clean optimum?
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "false_loops.hpp"
#include "hmt/graph/g2o_file.hpp"
#include "hmt/graph/pose_optimizer.hpp"

namespace hmt::benchmarks {
namespace {

using graph::Pose;

/// ATE: root mean square distance after the best rigid alignment of `a` to `b`.
double aligned_rmse(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  Eigen::Matrix3Xd from(3, a.size());
  Eigen::Matrix3Xd to(3, a.size());
  for (size_t k = 0; k < a.size(); ++k) {
    from.col(static_cast<Eigen::Index>(k)) = a[k].translation;
    to.col(static_cast<Eigen::Index>(k)) = b[k].translation;
  }
  const Eigen::Matrix4d T = Eigen::umeyama(from, to, false);
  const Eigen::Matrix3Xd rest =
      ((T.topLeftCorner<3, 3>() * from).colwise() + Eigen::Vector3d(T.topRightCorner<3, 1>())) - to;
  return std::sqrt(rest.squaredNorm() / static_cast<double>(a.size()));
}

/// The least that can be reached: the optimum over the true edges alone.
std::vector<Pose> oracle_poses(const CorruptedGraph& corrupted) {
  graph::PoseGraph part = corrupted.graph;
  part.edges.clear();
  for (size_t k = 0; k < corrupted.is_false.size(); ++k)
    if (!corrupted.is_false[k]) part.edges.push_back(corrupted.graph.edges[k]);
  return optimize(part, {}).poses;
}

struct Case {
  double share;
  int group_size;
  FalsePose kind;
  unsigned seed;
  bool shuffled;  ///< nodes in random order: nothing tells which edges are odometry
  int sessions;   ///< drives that only loops join
};

/// Share of the edges that `keep` picks and that were accepted.
template <class Predicate>
double share_accepted(const std::vector<bool>& inlier, const Predicate& keep) {
  int accepted = 0;
  int all = 0;
  for (size_t k = 0; k < inlier.size(); ++k) {
    if (!keep(k)) continue;
    ++all;
    accepted += inlier[k] ? 1 : 0;
  }
  return all > 0 ? static_cast<double>(accepted) / all : 1;
}

/// Poses of the nodes in the order of the graph that was not shuffled.
std::vector<Pose> in_order_of(const std::vector<Pose>& poses, const std::vector<int>& place) {
  std::vector<Pose> ordered;
  for (const int node : place) ordered.push_back(poses[static_cast<size_t>(node)]);
  return ordered;
}

graph::PoseGraph clean_graph(const std::string& folder, const std::string& name) {
  return graph::read_g2o(folder + "/" + name + ".g2o").graph;
}

void run_case(const std::string& name, const graph::PoseGraph& clean, const Case& c) {
  CorruptedGraph corrupted = add_false_loops(clean, c.share, c.group_size, c.kind, c.seed);
  if (c.sessions > 1) corrupted = cut_into_sessions(std::move(corrupted), c.sessions);
  const std::vector<Pose> oracle = oracle_poses(corrupted);
  if (c.shuffled) corrupted = shuffle_nodes(std::move(corrupted), c.seed);
  graph::PoseOptimizerOptions options;
  options.robust = graph::RobustMethod::gnc;
  options.initialization = graph::Initialization::best;
  const graph::PoseOptimizerResult result = optimize(corrupted.graph, options);
  const std::vector<bool>& inlier = result.report.inlier;
  const auto is_true_loop = [&](size_t k) {
    return corrupted.is_loop[k] && !corrupted.is_false[k];
  };
  const auto is_odometry = [&](size_t k) { return !corrupted.is_loop[k]; };
  double kept = 0;
  double kept_true = 0;
  for (size_t k = 0; k < inlier.size(); ++k) {
    kept += corrupted.is_loop[k] && inlier[k] ? 1 : 0;
    kept_true += is_true_loop(k) && inlier[k] ? 1 : 0;
  }
  const std::vector<Pose> poses = in_order_of(result.poses, corrupted.place);
  std::printf(
      "%-14s %3.0f %% %d %-10s %2u  precision %.4f recall %.4f odometry %.4f  ATE to clean %.4f m "
      "(oracle %.4f), to oracle %.4f m  %6.2f s\n",
      name.c_str(), 100 * c.share, c.group_size,
      c.kind == FalsePose::anywhere ? "anywhere" : "same_place", c.seed,
      kept_true / std::max(1.0, kept), share_accepted(inlier, is_true_loop),
      share_accepted(inlier, is_odometry), aligned_rmse(poses, clean.poses),
      aligned_rmse(oracle, clean.poses), aligned_rmse(poses, oracle), result.report.solve_s);
  std::fflush(stdout);
}

}  // namespace
}  // namespace hmt::benchmarks

// Arguments: the seeds as FIRST..LAST (or LAST, from 1), `chain`, `shuffled` (nodes in random
// order) or a number of sessions, the folder of the graphs, and the names of those to run.
int main(int argc, char** argv) {
  using namespace hmt;
  using benchmarks::FalsePose;
  if (argc < 4) return 2;
  const std::string seeds = argv[1];
  const size_t dots = seeds.find("..");
  const int first = dots == std::string::npos ? 1 : std::atoi(seeds.c_str());
  const int last = std::atoi(seeds.c_str() + (dots == std::string::npos ? 0 : dots + 2));
  const bool shuffled = std::string(argv[2]) == "shuffled";
  const int sessions = std::max(1, std::atoi(argv[2]));
  for (int i = 4; i < argc; ++i) {
    graph::PoseGraph clean = benchmarks::clean_graph(argv[3], argv[i]);
    graph::PoseOptimizerOptions options;
    options.initialization = graph::Initialization::best;
    clean.poses = optimize(clean, options).poses;
    for (int seed = first; seed <= last; ++seed)
      for (const FalsePose kind : {FalsePose::anywhere, FalsePose::same_place})
        for (const int group_size : {1, 5})
          for (const double share : {0.1, 0.3, 0.5})
            benchmarks::run_case(
                argv[i], clean,
                {share, group_size, kind, static_cast<unsigned>(seed), shuffled, sessions});
  }
  return 0;
}
