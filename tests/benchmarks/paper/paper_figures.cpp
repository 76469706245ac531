// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// The experiments of [Blanco 2009]: writes figures (SVG) and their numbers (CSV) to a folder and
// says which results of the paper came out. Exit code 1 if one did not.

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "figures.hpp"

namespace {

constexpr int kRuns = 150;  // as in the paper
constexpr int kThreads = 2;

bool report(const std::vector<hmt::paper::Claim>& claims) {
  bool all = true;
  for (const hmt::paper::Claim& claim : claims) {
    fmt::print("{}  {}\n", claim.holds ? "yes" : "NO ", claim.text);
    all = all && claim.holds;
  }
  std::fflush(stdout);
  return all;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string which = argc == 3 ? argv[2] : "all";
  if (argc < 2 || argc > 3) {
    fmt::print(stderr, "usage: paper_figures FOLDER [fig5|fig8|fig9]\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  const auto wanted = [&](const char* name) { return which == "all" || which == name; };
  bool all = true;
  if (wanted("fig5")) all &= report(hmt::paper::draw_three_rooms(folder));
  if (wanted("fig8")) all &= report(hmt::paper::draw_straight_path(folder, kRuns, true, kThreads));
  if (wanted("fig9")) {
    all &= report(hmt::paper::draw_sensors(folder, {"building", "rooms", "corridor"}, kThreads));
    const std::filesystem::path logs = std::filesystem::path(HMTMAP_DATA_DIR) / "laser2d";
    for (const char* name : {"intel", "fr079"})
      if (std::filesystem::exists(logs / (std::string(name) + ".clf.bz2")))
        all &= report(hmt::paper::draw_real_log(folder, logs, name, kThreads));
  }
  return all ? 0 : 1;
}
