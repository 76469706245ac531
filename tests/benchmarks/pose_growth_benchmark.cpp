// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Time and memory a pose as the graph grows: grid worlds of our own, driven row by row to and fro,
// with a loop to the row before at every fifth pose.
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <string>

#include "hmt/graph/pose_optimizer.hpp"
#include "hmt/graph/submap_optimizer.hpp"

namespace hmt::benchmarks {
namespace {

using graph::Pose;

constexpr double kNoise = 0.02;
constexpr int kLoopStride = 5;

/// Pose `i` of the drive through rows of `width` cells of one metre.
Pose true_pose(int i, int width) {
  const int row = i / width;
  const int column = row % 2 == 0 ? i % width : width - 1 - i % width;
  return Pose::planar(column, row, row % 2 == 0 ? 0 : std::numbers::pi);
}

graph::PoseGraph grid_world(int num_poses, unsigned seed) {
  const int width = static_cast<int>(std::sqrt(num_poses));
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal(0, kNoise);
  graph::PoseGraph world;
  const auto measure = [&](int from, int to) {
    const Pose T = relative_pose(true_pose(from, width), true_pose(to, width));
    const Pose noise = Pose::planar(normal(generator), normal(generator), normal(generator) / 4);
    graph::PoseGraphEdge edge{from, to, T * noise, graph::Matrix6d::Identity()};
    edge.information.diagonal() << 2500, 2500, 2500, 40000, 40000, 40000;
    world.edges.push_back(edge);
  };
  world.poses.push_back(true_pose(0, width));
  for (int i = 1; i < num_poses; ++i) {
    measure(i - 1, i);
    world.poses.push_back(world.poses.back() * world.edges.back().T_from_to);
    const int row = i / width;
    const int before = row * width - 1 - i % width;
    if (row > 0 && i % kLoopStride == 0 && before != i - 1) measure(before, i);
  }
  return world;
}

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace
}  // namespace hmt::benchmarks

// Arguments: the number of poses, and `submaps` to solve by submaps; one size a run, so that the
// peak of memory is its own.
int main(int argc, char** argv) {
  using namespace hmt;
  const int num_poses = argc > 1 ? std::atoi(argv[1]) : 1000;
  const bool by_submaps = argc > 2 && std::string(argv[2]) == "submaps";
  const graph::PoseGraph world = benchmarks::grid_world(num_poses, 1);
  const double before_mb = benchmarks::peak_rss_mb();
  graph::PoseOptimizerOptions options;
  options.initialization = graph::Initialization::best;
  options.threads = 2;
  graph::PoseOptimizerReport report;
  if (by_submaps) {
    const graph::SubmapOptimizerResult parts = optimize_by_submaps(world, options);
    report = parts.result.report;
    std::printf(
        "%d submaps, %d links: partition %.1f s, submaps %.1f s, links %.1f s, refinement %.1f s, "
        "chi2 before it %.6g\n",
        parts.submaps.submaps, parts.submaps.links, parts.submaps.partition_s,
        parts.submaps.submaps_s, parts.submaps.links_s, parts.submaps.refinement_s,
        parts.submaps.chi2_before_refinement);
  } else {
    report = optimize(world, options).report;
  }
  std::printf(
      "%8d poses %8zu edges  chi2 %.6g of %.0f in %d iterations  %.3f s, %.2f us a pose  "
      "%.0f MB (%.0f before), %.2f kB a pose\n",
      num_poses, world.edges.size(), report.chi2, report.degrees_of_freedom, report.iterations,
      report.solve_s, 1e6 * report.solve_s / num_poses, benchmarks::peak_rss_mb(), before_mb,
      1024 * benchmarks::peak_rss_mb() / num_poses);
  return 0;
}
