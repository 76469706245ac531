// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Loops replaced by false ones: does graduated non-convexity find them, and the clean optimum?
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
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

void run_case(const std::string& name, const graph::PoseGraph& clean, double share, int group_size,
              unsigned seed) {
  const CorruptedGraph corrupted = add_false_loops(clean, share, group_size, seed);
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
  std::printf(
      "%-12s %4.0f %% %5d %6u  ATE %8.4f m (all true edges %.4f m)  precision %.4f  "
      "recall %.4f  %6.2f s\n",
      name.c_str(), 100 * share, group_size, seed, aligned_rmse(result.poses, clean.poses),
      aligned_rmse(oracle_poses(corrupted), clean.poses),
      static_cast<double>(kept_true) / std::max(1, kept),
      static_cast<double>(kept_true) / std::max(1, true_loops), result.report.solve_s);
  std::fflush(stdout);
}

}  // namespace
}  // namespace hmt::benchmarks

// Arguments: the folder of the graphs, and the names of those to run.
int main(int argc, char** argv) {
  using namespace hmt;
  for (int i = 2; i < argc; ++i) {
    graph::G2oFile file = graph::read_g2o(std::string(argv[1]) + "/" + argv[i] + ".g2o");
    graph::PoseOptimizerOptions options;
    options.initialization = graph::Initialization::best;
    file.graph.poses = optimize(file.graph, options).poses;
    for (const int group_size : {1, 5})
      for (const double share : {0.1, 0.3, 0.5})
        benchmarks::run_case(argv[i], file.graph, share, group_size, 1);
  }
  return 0;
}
