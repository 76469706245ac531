// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Time of the overlap graph of all scans of fr079 and its growth with the log, beside the exact
// overlap of all pairs of a subset in the same run. Usage: overlap_benchmark [THREADS [SCANS]]: the
// first SCANS alone

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <numbers>

#include "hmt/submap/export/trajectory.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "read_log.hpp"

namespace hmt::test {
namespace {

using submap::Pose;

struct Scans {
  std::vector<submap::Observation> observations;
  std::vector<submap::Keyframe> keyframes;
  std::vector<Pose> T_world_keyframe;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Every scan is a keyframe at its reference pose; the few scans without one follow by odometry.
Scans read_fr079(const std::filesystem::path& folder) {
  Scans scans;
  scans.observations = read_log(folder / "fr079.clf.bz2");
  std::map<int64_t, Pose> reference;
  for (const auto& p : submap::read_tum(folder / "fr079.keyframes.tum")) {
    reference[std::llround(p.stamp_s * 1e4)] = p.T_world_robot;
  }
  Pose T_world_odom = reference.begin()->second * scans.observations.front().T_odom_robot.inverse();
  for (size_t i = 0; i < scans.observations.size(); ++i) {
    const submap::Observation& o = scans.observations[i];
    const auto found = reference.find(std::llround(o.stamp_s * 1e4));
    if (found != reference.end()) T_world_odom = found->second * o.T_odom_robot.inverse();
    scans.T_world_keyframe.push_back(T_world_odom * o.T_odom_robot);
    scans.keyframes.push_back({static_cast<int>(i), static_cast<int64_t>(i), o.stamp_s, {}});
  }
  return scans;
}

/// As good as the reference poses are: some centimetres, half a degree.
submap::Matrix6d pair_covariance() {
  submap::Matrix6d covariance = submap::Matrix6d::Zero();
  covariance(0, 0) = covariance(1, 1) = 0.05 * 0.05;
  covariance(5, 5) = std::pow(0.5 * std::numbers::pi / 180, 2);
  return covariance;
}

/// Microseconds for each of all pairs of every `step`-th scan, and the largest and mean difference
/// of Omega from them where it has an arc; how many it has not, later visits with others.
void compare_with_all_pairs(const Scans& scans, const graph::WeightedGraph& omega, int step) {
  const submap::OverlapOptions options;
  const std::clock_t start = std::clock();
  double largest = 0, sum = 0;
  int pairs = 0, arcs = 0, left_out = 0;
  for (int a = 0; a < omega.num_nodes(); a += step) {
    for (int b = a + step; b < omega.num_nodes(); b += step) {
      const auto at = [](int i) { return static_cast<size_t>(i); };
      const double exact = submap::observation_overlap(
          scans.observations[at(a)], scans.observations[at(b)],
          graph::relative_pose(scans.T_world_keyframe[at(a)], scans.T_world_keyframe[at(b)]),
          pair_covariance(), options);
      const double kept = exact < options.min_overlap ? 0.0 : exact;
      ++pairs;
      if (kept > 0 && omega.weight(a, b) == 0) {
        ++left_out;
        continue;
      }
      largest = std::max(largest, std::abs(omega.weight(a, b) - kept));
      sum += std::abs(omega.weight(a, b) - kept);
      arcs += kept > 0 ? 1 : 0;
    }
  }
  const double all_pairs_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC *
                             omega.num_nodes() * (omega.num_nodes() - 1.0) / 2 / pairs;
  std::printf("all pairs, one by one, 1 thread: %d pairs, extrapolated to all %.1f s cpu\n", pairs,
              all_pairs_s);
  std::printf(
      "difference of Omega from them: mean %.6f, largest %.6f; %d with an arc, %d left out\n",
      sum / pairs, largest, arcs, left_out);
}

graph::WeightedGraph time_overlap_graph(const Scans& scans, int count, int threads) {
  const submap::ObservationVector store(scans.observations);
  submap::Run run;
  run.threads = threads;
  const auto n = static_cast<size_t>(count);
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t cpu_start = std::clock();
  auto omega = submap::overlap_graph(
      std::span(scans.keyframes).first(n), std::span(scans.T_world_keyframe).first(n),
      [](int, int) { return std::optional(pair_covariance()); }, store, {}, run);
  std::printf("%6d scans %9lld arcs %8.2f s wall %8.2f s cpu\n", count,
              static_cast<long long>(omega.num_arcs()), seconds_since(start),
              static_cast<double>(std::clock() - cpu_start) / CLOCKS_PER_SEC);
  std::fflush(stdout);
  return omega;
}

}  // namespace
}  // namespace hmt::test

int main(int argc, char** argv) {
  using namespace hmt::test;
  const int threads = argc > 1 ? std::atoi(argv[1]) : 2;
  const Scans scans = read_fr079(std::filesystem::path(HMTMAP_DATA_DIR) / "laser2d");
  const int all = static_cast<int>(scans.keyframes.size());
  if (argc > 2) {
    time_overlap_graph(scans, std::clamp(std::atoi(argv[2]), 1, all), threads);
    return 0;
  }
  for (const int count : {500, 1000, 2000}) time_overlap_graph(scans, count, threads);
  compare_with_all_pairs(scans, time_overlap_graph(scans, all, threads), 40);
}
