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
};

void run_case(const std::string& name, const graph::PoseGraph& clean, const Case& c) {
  const CorruptedGraph corrupted = add_false_loops(clean, c.share, c.group_size, c.kind, c.seed);
  graph::PoseOptimizerOptions options;
  options.robust = graph::RobustMethod::gnc;
  const graph::PoseOptimizerResult result = optimize(corrupted.graph, options);
  int kept_true = 0;
  int kept = 0;
  int true_loops = 0;
  for (size_t k = 0; k < corrupted.is_loop.size(); ++k) {
    if (!corrupted.is_loop[k]) continue;
    true_loops += corrupted.is_false[k] ? 0 : 1;
    kept += result.report.inlier[k] ? 1 : 0;
    kept_true += result.report.inlier[k] && !corrupted.is_false[k] ? 1 : 0;
  }
  const std::vector<Pose> oracle = oracle_poses(corrupted);
  std::printf(
      "%-14s %3.0f %% %d %-10s %2u  precision %.4f recall %.4f  ATE to clean %.4f m (oracle %.4f), "
      "to oracle %.4f m  %6.2f s\n",
      name.c_str(), 100 * c.share, c.group_size,
      c.kind == FalsePose::anywhere ? "anywhere" : "same_place", c.seed,
      static_cast<double>(kept_true) / std::max(1, kept),
      static_cast<double>(kept_true) / std::max(1, true_loops),
      aligned_rmse(result.poses, clean.poses), aligned_rmse(oracle, clean.poses),
      aligned_rmse(result.poses, oracle), result.report.solve_s);
  std::fflush(stdout);
}

}  // namespace
}  // namespace hmt::benchmarks

// Arguments: the number of seeds, the folder of the graphs, and the names of those to run.
int main(int argc, char** argv) {
  using namespace hmt;
  using benchmarks::FalsePose;
  const auto seeds = static_cast<unsigned>(argc > 1 ? std::atoi(argv[1]) : 1);
  for (int i = 3; i < argc; ++i) {
    graph::G2oFile file = graph::read_g2o(std::string(argv[2]) + "/" + argv[i] + ".g2o");
    graph::PoseOptimizerOptions options;
    options.initialization = graph::Initialization::best;
    file.graph.poses = optimize(file.graph, options).poses;
    for (unsigned seed = 1; seed <= seeds; ++seed)
      for (const FalsePose kind : {FalsePose::anywhere, FalsePose::same_place})
        for (const int group_size : {1, 5})
          for (const double share : {0.1, 0.3, 0.5})
            benchmarks::run_case(argv[i], file.graph, {share, group_size, kind, seed});
  }
  return 0;
}
