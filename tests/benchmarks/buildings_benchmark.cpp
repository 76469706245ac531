// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Ten simulated buildings that look the same in many places: what is closed, what is wrong.
#include <cstdio>
#include <cstdlib>

#include "building_run.hpp"

namespace {

constexpr int kRuns = 10;

}  // namespace

int main(int argc, char** argv) {
  const int threads = argc > 1 ? std::atoi(argv[1]) : 2;
  std::printf(
      "world      seed  closures  false  revisits  closed   ATE [m]  submap NEES  link NEES\n");
  double submap_nees = 0, link_nees = 0;
  for (const char* world : {"ring", "symmetric"})
    for (uint64_t seed = 1; seed <= 5; ++seed) {
      const hmt::test::BuildingFigures f =
          hmt::test::run_building({.world = world, .seed = seed, .laps = 2}, threads);
      std::printf("%-10s %4d  %8d  %5d  %8d  %4.0f %%  %8.4f  %6.2f (%d)  %5.2f (%d)\n", world,
                  static_cast<int>(seed), f.closures, f.false_closures, f.revisits,
                  f.revisits > 0 ? 100.0 * f.closed / f.revisits : 100.0, f.ate_rmse_m,
                  f.submap_nees, f.submaps, f.link_nees, f.links);
      std::fflush(stdout);
      submap_nees += f.submap_nees / kRuns;
      link_nees += f.link_nees / kRuns;
    }
  // The errors of one run hang together, so each run is one sample of three degrees of freedom.
  std::printf("mean NEES of submaps %.2f, of links %.2f; 95 %% interval 1.68 to 4.70\n",
              submap_nees, link_nees);
  return 0;
}
