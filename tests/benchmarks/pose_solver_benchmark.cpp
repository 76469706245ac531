// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Our initialization and optimization together against the optimization alone of plain Ceres,
// which starts from our initialization. The best of three runs of each.
#include <algorithm>
#include <cstdio>
#include <string>

#include "hmt/graph/g2o_file.hpp"
#include "hmt/graph/pose_initialization.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "plain_ceres.hpp"

namespace hmt::benchmarks {
namespace {

constexpr int kRuns = 3;

void run_case(const std::string& name, const graph::G2oFile& file) {
  graph::PoseOptimizerOptions options;
  options.initialization = graph::Initialization::best;
  graph::PoseOptimizerReport ours;
  double ours_s = 1e9;
  PlainCeresResult plain;
  double plain_s = 1e9;
  graph::PoseGraph started = file.graph;
  started.poses = initial_poses(file.graph, options.initialization).poses;
  for (int run = 0; run < kRuns; ++run) {
    ours = optimize(file.graph, options).report;
    ours_s = std::min(ours_s, ours.solve_s);
    plain = solve_with_plain_ceres(started);
    plain_s = std::min(plain_s, plain.solve_s);
  }
  std::printf(
      "%-15s %6zu %6zu  ours %.9g in %2d iterations %.4f s  plain %.9g in %2d %.4f s  "
      "ratio %.2f\n",
      name.c_str(), file.graph.poses.size(), file.graph.edges.size(), ours.chi2, ours.iterations,
      ours_s, plain.chi2, plain.iterations, plain_s, ours_s / plain_s);
  std::fflush(stdout);
}

}  // namespace
}  // namespace hmt::benchmarks

// Arguments: the folder of the graphs, and the names of those to run.
int main(int argc, char** argv) {
  for (int i = 2; i < argc; ++i)
    hmt::benchmarks::run_case(argv[i],
                              hmt::graph::read_g2o(std::string(argv[1]) + "/" + argv[i] + ".g2o"));
  return 0;
}
