// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Ten simulated buildings that look the same in many places: what is closed, what is wrong.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "building_run.hpp"

namespace {

constexpr uint64_t kSeeds = 5;

/// Sums over the buildings that were run.
struct Nees {
  double submaps = 0;
  double links = 0;
  int runs = 0;
};

void run(const std::string& world, uint64_t seed, int threads, Nees& nees) {
  const hmt::test::BuildingFigures f =
      hmt::test::run_building({.world = world, .seed = seed, .laps = 2}, threads);
  std::printf("%-10s %4d  %8d  %5d  %8d  %4.0f %%  %8.4f  %6.2f (%d)  %5.2f (%d)\n", world.c_str(),
              static_cast<int>(seed), f.closures, f.false_closures, f.revisits,
              f.revisits > 0 ? 100.0 * f.closed / f.revisits : 100.0, f.ate_rmse_m, f.submap_nees,
              f.submaps, f.link_nees, f.links);
  std::fflush(stdout);
  nees.submaps += f.submap_nees;
  nees.links += f.link_nees;
  ++nees.runs;
}

}  // namespace

/// buildings_benchmark [threads [world seed]]: all ten, or one of them.
int main(int argc, char** argv) {
  const int threads = argc > 1 ? std::atoi(argv[1]) : 2;
  std::printf(
      "world      seed  closures  false  revisits  closed   ATE [m]  submap NEES  link NEES\n");
  Nees nees;
  if (argc > 3)
    run(argv[2], static_cast<uint64_t>(std::atoll(argv[3])), threads, nees);
  else
    for (const char* world : {"ring", "symmetric"})
      for (uint64_t seed = 1; seed <= kSeeds; ++seed) run(world, seed, threads, nees);
  // The errors of one run hang together, so each run is one sample of three degrees of freedom.
  std::printf("mean NEES of submaps %.2f, of links %.2f; 95 %% interval 1.68 to 4.70\n",
              nees.submaps / nees.runs, nees.links / nees.runs);
  return 0;
}
