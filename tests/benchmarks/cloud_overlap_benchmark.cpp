// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Time of the overlap graph of simulated lidar clouds and its growth with the log: a robot drives
// through one hall after the other, so the number of arcs grows with the log. Clouds of 5000 points
// are compared point by point, those of 40000 by voxels. Usage: cloud_overlap_benchmark [THREADS]

#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "hmt/submap/overlap/overlap.hpp"
#include "libsubmap/overlap/hall.hpp"

namespace hmt::test {
namespace {

using submap::Pose;

constexpr int kCloudsPerHall = 20;

Pose pose_in_hall(int i) {
  return {{2.0 * i - 10, 0.3 * (i % 3), 0}, Eigen::Quaterniond::Identity()};
}

std::vector<submap::Observation> clouds_of_a_hall(int rings, int columns) {
  std::vector<submap::Observation> observations;
  for (int i = 0; i < kCloudsPerHall; ++i) {
    observations.emplace_back().readings = {cloud_of_a_hall(pose_in_hall(i), rings, columns)};
  }
  return observations;
}

void time_overlap_graph(const submap::ObservationStore& store, int count, int threads) {
  std::vector<submap::Keyframe> keyframes;
  std::vector<Pose> T_world_keyframe;
  for (int i = 0; i < count; ++i) {
    const Pose T_world_hall{{0, 100.0 * (i / kCloudsPerHall), 0}, Eigen::Quaterniond::Identity()};
    keyframes.push_back({i, i % kCloudsPerHall, 0, {}});
    T_world_keyframe.push_back(T_world_hall * pose_in_hall(i % kCloudsPerHall));
  }
  submap::Run run;
  run.threads = threads;
  const submap::Matrix6d covariance = 1e-5 * submap::Matrix6d::Identity();
  const std::clock_t start = std::clock();
  const auto omega = submap::overlap_graph(
      keyframes, T_world_keyframe, [&](int, int) { return std::optional(covariance); }, store, {},
      run);
  std::printf("%6d clouds %8lld arcs %8.2f s cpu\n", count,
              static_cast<long long>(omega.num_arcs()),
              static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  std::fflush(stdout);
}

}  // namespace
}  // namespace hmt::test

int main(int argc, char** argv) {
  using namespace hmt::test;
  const int threads = argc > 1 ? std::atoi(argv[1]) : 2;
  for (const int columns : {156, 1250}) {
    const auto observations = clouds_of_a_hall(32, columns);
    std::printf("%zu points a cloud\n", observations.front().readings.front().points_sensor.size());
    const hmt::submap::ObservationVector store(observations);
    for (const int count : {100, 200, 400, 800}) time_overlap_graph(store, count, threads);
  }
}
