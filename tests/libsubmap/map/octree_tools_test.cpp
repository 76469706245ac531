// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Debian's octomap-tools read what is exported; skipped where they are not installed.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hmt/submap/map/octree.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

/// A hemisphere of 3 m around the robot.
std::string tree_of_a_dome() {
  std::vector<Observation> observations(1);
  observations[0].readings.resize(1);
  for (float up = 0.05f; up < 1.5f; up += 0.02f)
    for (float around = 0; around < 6.28f; around += 0.02f)
      observations[0].readings[0].points_sensor.push_back(
          3 * Eigen::Vector3f(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around),
                              std::sin(up)));
  return build_octree({{{0, {}}}}, ObservationVector(std::move(observations)), Space::se3, {0.1});
}

/// Volume of the free ([0]) and of the occupied cells ([1]), cubic metres.
std::array<double, 2> volumes(std::string_view ot_bytes) {
  std::array<double, 2> sums = {0, 0};
  for (const OctreeCell& cell : octree_cells(ot_bytes))
    sums[cell.occupied ? 1 : 0] += std::pow(cell.size_m, 3);
  return sums;
}

/// What convert_octree makes an .ot tree of.
std::string converted(const fs::path& folder, const std::string& name, const std::string& bytes) {
  std::ofstream(folder / name, std::ios::binary) << bytes;
  const std::string command =
      "cd '" + folder.string() + "' && convert_octree " + name + " converted.ot > /dev/null 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::ostringstream text;
  text << std::ifstream(folder / "converted.ot", std::ios::binary).rdbuf();
  return text.str();
}

TEST(OctreeTools, ReadBothFormats) {
  if (std::system("command -v convert_octree > /dev/null") != 0)
    GTEST_SKIP() << "needs convert_octree of octomap-tools";
  const test::TemporaryFolder folder;
  const std::string ot = tree_of_a_dome();
  const auto expected = volumes(ot);
  EXPECT_GT(expected[0], 50);  // 2/3 pi 3^3 = 56.5 but for the cells at the floor and the dome
  EXPECT_GT(expected[1], 3);   // 2 pi 3^2 0.1 = 5.7, or somewhat more or less by the cells it cuts
  const auto from_ot = volumes(converted(folder.path(), "tree.ot", ot));
  const auto from_bt = volumes(converted(folder.path(), "tree.bt", octree_to_bt(ot)));
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(from_ot[k], expected[k], 1e-6);
    EXPECT_NEAR(from_bt[k], expected[k], 1e-6);
  }
}

}  // namespace
}  // namespace hmt::submap
