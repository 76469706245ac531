// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// A laser, and a camera that recognizes markers: one map of both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>

#include "hmt/submap/export/evaluation.hpp"
#include "hmt/submap/export/landmarks_file.hpp"
#include "hmt/submap/pipeline.hpp"
#include "recordings/marked_drive.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

HybridMap map_of(const std::filesystem::path& log) {
  Run run;
  run.threads = 2;
  return build_map(log, log.string() + ".hmt", {}, MapFile::Existing::resume, run).file.load_map();
}

HybridMap map_of(const test::MarkedDrive& drive) {
  const test::TemporaryFolder folder;
  test::write_file(folder.path() / "log.bag", test::ros1_bag(drive.messages, {"lz4", 100}));
  return map_of(folder.path() / "log.bag");
}

double trajectory_error_m(const HybridMap& map, const test::MarkedDrive& drive) {
  EXPECT_EQ(map.track.observations.size(), drive.truth.size());
  const double error_m = evaluate_trajectory(stamped_trajectory(map), drive.truth).ate_rmse_m;
  std::cout << "ATE " << error_m << " m" << std::endl;
  return error_m;
}

double landmark_error_m(const HybridMap& map, const test::MarkedDrive& drive) {
  const LandmarkError error = evaluate_landmarks(map, drive.markers);
  EXPECT_EQ(error.matched, error.true_landmarks);
  std::cout << "landmarks " << error.rmse_m << " m" << std::endl;
  return error.rmse_m;
}

TEST(Markers, BesideALaserAreInTheMap) {
  const test::MarkedDrive drive({.laps = 2}, Wire::ros1);
  const HybridMap map = map_of(drive);
  EXPECT_LT(trajectory_error_m(map, drive), 0.02);
  EXPECT_LT(landmark_error_m(map, drive), 0.03);
  EXPECT_EQ(map.landmarks.size(), drive.markers.size());
  EXPECT_GT(map.sightings.size(), 0.99 * static_cast<double>(drive.sightings));
  // Both sensors hold the map together: registrations, and landmarks in submaps and links.
  EXPECT_GT(map.submaps.size(), 1u);
  for (const Submap& submap : map.submaps) EXPECT_FALSE(submap.landmarks.empty());
  EXPECT_TRUE(std::ranges::any_of(map.links, [](const Link& l) { return !l.landmarks.empty(); }));
  EXPECT_TRUE(std::ranges::any_of(
      map.constraints, [](const Constraint& c) { return c.kind == ConstraintKind::registration; }));
}

// Cameras tell rarely how sure they are.
TEST(Markers, WithoutTheirCovarianceDoNoHarm) {
  const test::MarkedDrive drive({.laps = 2, .tells_covariance = false}, Wire::ros1);
  const HybridMap map = map_of(drive);
  EXPECT_LT(trajectory_error_m(map, drive), 0.02);
  EXPECT_LT(landmark_error_m(map, drive), 0.04);
}

// Bare walls leave the way along them to the odometry; markers tell it.
TEST(Markers, HoldAMapTogetherWhereWallsTellNothing) {
  const test::MarkedDriveOptions tunnel = {.world = "tunnel", .laser_range_m = 8};
  const test::MarkedDrive with(tunnel, Wire::ros1);
  test::MarkedDriveOptions bare = tunnel;
  bare.marker_spacing_m = 0;
  const test::MarkedDrive without(bare, Wire::ros1);
  const double with_m = trajectory_error_m(map_of(with), with);
  const double without_m = trajectory_error_m(map_of(without), without);
  EXPECT_LT(with_m, 0.3);
  EXPECT_GT(without_m, 3 * with_m);
}

// In the second round some markers are taken for others across the building.
TEST(Markers, TakenForOthersDoNotBendTheMap) {
  const test::MarkedDrive right({.laps = 2}, Wire::ros1);
  test::MarkedDriveOptions options = {.laps = 2};
  const int64_t first = right.markers.begin()->first;
  const int64_t last = right.markers.rbegin()->first;
  options.mistaken = {{first, last}, {last, first}};
  const test::MarkedDrive wrong(options, Wire::ros1);
  const HybridMap map = map_of(wrong);
  EXPECT_LT(trajectory_error_m(map, wrong), 0.02);
  EXPECT_LT(map.sightings.size(), wrong.sightings);
}

TEST(Markers, GiveTheSameMapInEveryFormat) {
  const test::TemporaryFolder folder;
  const test::MarkedDrive ros1({}, Wire::ros1);
  const test::MarkedDrive ros2({}, Wire::cdr);
  test::write_file(folder.path() / "log.bag", test::ros1_bag(ros1.messages, {"bz2", 100}));
  test::write_file(folder.path() / "log.mcap", test::mcap_file(ros2.messages, {"zstd", 100}));
  test::write_sqlite_bag(folder.path() / "log.db3", ros2.messages);
  const HybridMap bag = map_of(folder.path() / "log.bag");
  EXPECT_FALSE(bag.landmarks.empty());
  for (const char* name : {"log.mcap", "log.db3"}) {
    const HybridMap other = map_of(folder.path() / name);
    EXPECT_EQ(other.landmarks, bag.landmarks) << name;
    EXPECT_EQ(other.sightings, bag.sightings) << name;
    EXPECT_EQ(other.T_world_submap, bag.T_world_submap) << name;
  }
}

}  // namespace
}  // namespace hmt::submap
