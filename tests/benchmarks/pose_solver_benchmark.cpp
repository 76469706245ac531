// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Our initialization and optimization together against the optimization alone of plain Ceres,
// which starts from our initialization; and our optimization alone from there. The best of three
// runs of each.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>

#include "hmt/graph/g2o_file.hpp"
#include "hmt/graph/pose_initialization.hpp"
#include "hmt/graph/pose_optimizer.hpp"
#include "plain_ceres.hpp"

namespace hmt::benchmarks {
namespace {

constexpr int kRuns = 3;

/// CPU time of the process: what wall time is not, comparable on a machine that others use.
double cpu_s() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The least wall time and the least CPU time of several runs.
struct Times {
  double wall_s = 1e9;
  double cpu_s = 1e9;
  void add(double wall, double cpu) {
    wall_s = std::min(wall_s, wall);
    cpu_s = std::min(cpu_s, cpu);
  }
};

void run_case(const std::string& name, const graph::G2oFile& file) {
  graph::PoseOptimizerOptions options;
  options.initialization = graph::Initialization::best;
  graph::PoseOptimizerReport ours;
  PlainCeresResult plain;
  Times all, alone, plainly;
  graph::PoseGraph started = file.graph;
  started.poses = initial_poses(file.graph, options.initialization).poses;
  for (int run = 0; run < kRuns; ++run) {
    const double begin = cpu_s();
    ours = optimize(file.graph, options).report;
    const double optimized = cpu_s();
    const double alone_s = optimize(started, {}).report.solve_s;
    const double refined = cpu_s();
    plain = solve_with_plain_ceres(started);
    all.add(ours.solve_s, optimized - begin);
    alone.add(alone_s, refined - optimized);
    plainly.add(plain.solve_s, cpu_s() - refined);
  }
  std::printf(
      "%-15s %6zu %6zu  ours %.9g in %2d iterations, wall %.4f s cpu %.4f s, alone %.4f s %.4f s  "
      "plain %.9g in %2d, %.4f s %.4f s  ratio: all %.2f cpu %.2f, alone %.2f cpu %.2f\n",
      name.c_str(), file.graph.poses.size(), file.graph.edges.size(), ours.chi2, ours.iterations,
      all.wall_s, all.cpu_s, alone.wall_s, alone.cpu_s, plain.chi2, plain.iterations,
      plainly.wall_s, plainly.cpu_s, all.wall_s / plainly.wall_s, all.cpu_s / plainly.cpu_s,
      alone.wall_s / plainly.wall_s, alone.cpu_s / plainly.cpu_s);
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
