// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Ten simulated buildings that look the same in many places: what is closed, what is wrong.
#include <cstdio>
#include <cstdlib>

#include "building_run.hpp"

int main(int argc, char** argv) {
  const int threads = argc > 1 ? std::atoi(argv[1]) : 2;
  std::printf(
      "world      seed  closures  false  revisits  closed   ATE [m]  submap NEES  link NEES\n");
  for (const char* world : {"ring", "symmetric"})
    for (uint64_t seed = 1; seed <= 5; ++seed) {
      const hmt::test::BuildingFigures f =
          hmt::test::run_building({.world = world, .seed = seed, .laps = 2}, threads);
      std::printf("%-10s %4d  %8d  %5d  %8d  %4.0f %%  %8.4f  %6.2f (%d)  %5.2f (%d)\n", world,
                  static_cast<int>(seed), f.closures, f.false_closures, f.revisits,
                  f.revisits > 0 ? 100.0 * f.closed / f.revisits : 100.0, f.ate_rmse_m,
                  f.submap_nees, f.submaps, f.link_nees, f.links);
      std::fflush(stdout);
    }
  return 0;
}
