// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/export_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "../map/sample_map.hpp"
#include "hmt/submap/export/occupancy_image.hpp"
#include "hmt/submap/export/submap_cloud.hpp"
#include "hmt/submap/map/octree.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;
using test::sample_map;
using test::sample_observation;
using test::sample_origin;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::string content(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

std::map<std::string, std::string> contents(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).string()] = content(entry.path());
  return files;
}

/// The sample map with its octrees, in a file.
MapFile sample_file(const fs::path& path) {
  test::write_sample_map(path);
  MapFile file = MapFile::open_for_run(path, sample_origin(), MapFile::Existing::resume);
  const HybridMap map = sample_map();
  StageWriter stage = file.begin("octrees");
  for (const Submap& submap : map.submaps)
    stage.put_octree(submap.id, build_octree(observations_in_submap(map.track, submap), file,
                                             map.track.space, {0.1}));
  stage.commit();
  return file;
}

Run run_with(int threads) {
  Run run;
  run.threads = threads;
  return run;
}

TEST(ExportMap, WritesEveryFileThatItReturns) {
  const TemporaryFolder folder;
  const MapFile file = sample_file(folder / "a.hmt");
  const auto files = export_map(file, folder / "out", {}, run_with(1));
  const auto written = contents(folder / "out");
  EXPECT_EQ(files.size(), written.size());
  for (const std::string& name : files) EXPECT_TRUE(written.contains(name)) << name;
  EXPECT_TRUE(written.contains("submaps/0001.bt"));
  EXPECT_EQ(written.at("partition.csv"), "keyframe,stamp_s,submap\n0,100.1,0\n1,100.3,1\n");
  EXPECT_THAT(written.at("topology.dot"), HasSubstr("s0 -- s1 [label=\"0.200\", color=red]"));
  EXPECT_THAT(written.at("topology.graphml"), HasSubstr("<edge source=\"s0\" target=\"s1\">"));
  EXPECT_THAT(written.at("topology.json"), HasSubstr("\"information_loss\": 0.03"));
  EXPECT_THAT(written.at("pose_graph.g2o"), HasSubstr("EDGE_SE2 0 1 2 0 1.4999"));
  EXPECT_THAT(written.at("loops.jsonl"), HasSubstr("\"verdict\":\"ambiguous\""));
  EXPECT_THAT(written.at("report.html"), HasSubstr("logs/sample.clf"));
}

// Submap 1 stands at (2, 0) and is turned left by 90 degrees; observation 1 is 1 m before its
// keyframe, which is the frame of submap 0, turned left by 0.1.
TEST(ExportMap, TrajectoryHasEveryObservationInTheWorld) {
  const TemporaryFolder folder;
  ExportOptions options;
  options.parts = {"trajectory"};
  export_map(sample_file(folder / "a.hmt"), folder / "out", options, run_with(1));
  std::istringstream lines(content(folder / "out/trajectory.tum"));
  std::vector<double> numbers{std::istream_iterator<double>(lines), {}};
  ASSERT_EQ(numbers.size(), 3u * 8);
  EXPECT_EQ(numbers[8], 100.2);
  EXPECT_NEAR(numbers[9], 1, 1e-9);
  EXPECT_NEAR(numbers[8 + 6], std::sin(0.05), 1e-9);
  EXPECT_EQ(numbers[16], 100.3);
  EXPECT_NEAR(numbers[17], 2, 1e-9);
  EXPECT_NEAR(numbers[16 + 6], std::sqrt(0.5), 1e-9);
}

TEST(ExportMap, SameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const MapFile file = sample_file(folder / "a.hmt");
  export_map(file, folder / "one", {}, run_with(1));
  export_map(file, folder / "four", {}, run_with(4));
  EXPECT_EQ(contents(folder / "one"), contents(folder / "four"));
}

TEST(ExportMap, ReplacesNothingUnlessAsked) {
  const TemporaryFolder folder;
  const MapFile file = sample_file(folder / "a.hmt");
  fs::create_directories(folder / "out");
  std::ofstream(folder / "out/loops.jsonl") << "mine";
  try {
    export_map(file, folder / "out", {}, run_with(1));
    FAIL() << "replaced a file";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("loops.jsonl"));
  }
  EXPECT_EQ(contents(folder / "out").size(), 1u) << "wrote before it looked";
  ExportOptions options;
  options.overwrite = true;
  export_map(file, folder / "out", options, run_with(1));
  EXPECT_THAT(content(folder / "out/loops.jsonl"), Not(HasSubstr("mine")));
}

TEST(ExportMap, RefusesWhatItCannotDo) {
  const TemporaryFolder folder;
  const MapFile file = sample_file(folder / "a.hmt");
  ExportOptions unknown;
  unknown.parts = {"pictures"};
  EXPECT_THROW(export_map(file, folder / "out", unknown, run_with(1)), InputError);
  EXPECT_THROW(export_map(file, folder / "a.hmt", {}, run_with(1)), InputError);
  ExportOptions coarse;
  coarse.map_resolution_m = 0;
  EXPECT_THROW(export_map(file, folder / "out", coarse, run_with(1)), InputError);
  ExportOptions banded;
  banded.height_band_m = {0.0, 1.0};
  EXPECT_THROW(export_map(file, folder / "out", banded, run_with(1)), InputError);
}

/// A store with one observation of these points, seen from the origin of the robot.
ObservationVector store_of(std::vector<Eigen::Vector3f> points) {
  Observation observation;
  observation.readings.resize(1);
  observation.readings[0].max_range_m = 50;
  observation.readings[0].points_sensor = std::move(points);
  return ObservationVector({observation});
}

// One beam along x from (0.5, 0.5) to the wall at (2.5, 0.5), another one up to (0.5, 1.5); cells
// of 1 m and a border of one:
//
//   y  2  ? ? ? ? ?
//      1  ? # ? ? ?
//      0  ? . . # ?
//     -1  ? ? ? ? ?
//        -1 0 1 2 3  x
TEST(OccupancyImage, WallFreeSpaceAndUnknown) {
  const auto store = store_of({{2, 0, 0}, {0, 1, 0}});
  const std::vector<PlacedObservation> placed = {{0, Pose::planar(0.5, 0.5, 0)}};
  const OccupancyImage image = draw_occupancy(placed, store, {}, 1.0, run_with(1));
  ASSERT_EQ(image.width, 5);
  ASSERT_EQ(image.height, 4);
  EXPECT_EQ(image.origin, Eigen::Vector2d(-1, -1));
  EXPECT_EQ(image.at(1, 1), Occupancy::free);
  EXPECT_EQ(image.at(2, 1), Occupancy::free);
  EXPECT_EQ(image.at(3, 1), Occupancy::occupied);
  EXPECT_EQ(image.at(1, 2), Occupancy::occupied);
  EXPECT_EQ(image.at(2, 2), Occupancy::unknown);
  // In the file the highest y comes first.
  const std::string gray(
      "\xcd\xcd\xcd\xcd\xcd"
      "\xcd\x00\xcd\xcd\xcd"
      "\xcd\xfe\xfe\x00\xcd"
      "\xcd\xcd\xcd\xcd\xcd",
      20);
  EXPECT_EQ(to_pgm(image), "P5\n5 4\n255\n" + gray);
  EXPECT_EQ(to_map_yaml(image, "m.pgm"),
            "image: m.pgm\nresolution: 1\norigin: [-1, -1, 0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST(OccupancyImage, FarFromTheOriginIsDrawnToo) {
  const auto store = store_of({{2, 0, 0}});
  const std::vector<PlacedObservation> placed = {{0, Pose::planar(4e6 + 0.5, 0.5, 0)}};
  const OccupancyImage image = draw_occupancy(placed, store, {}, 1.0, run_with(1));
  EXPECT_EQ(image.origin, Eigen::Vector2d(4e6 - 1, -1));
  EXPECT_EQ(image.width, 5);
}

TEST(OccupancyImage, NothingSeenIsOneUnknownCell) {
  const OccupancyImage image = draw_occupancy({}, store_of({}), {}, 0.05, run_with(1));
  EXPECT_EQ(image.cells, std::vector<Occupancy>{Occupancy::unknown});
}

// Seen from (0.5, 0.5), 2 m high, with the band from 0.5 to 1.5 m above the ground: the floor 3 m
// ahead, where the beam is in the band from x = 1.25 to 2.75; the wall at x = 4.5 in the band,
// which the beam to it enters at x = 2.5; and what hangs from a ceiling, far too high.
//
//   x  -1 0 1 2 3 4 5
//       ? . . . # ?     (from x = 1)
TEST(OccupancyImage, ShowsOfCloudsWhatLiesInTheHeightBand) {
  const auto store = store_of({{3, 0, -2}, {4, 0, -1}, {2, 0, 3}});
  const std::vector<PlacedObservation> placed = {
      {0, Pose{{0.5, 0.5, 2}, Eigen::Quaterniond::Identity()}}};
  const HeightBand band{-1.5, -0.5, {0, 0}};
  const OccupancyImage image = draw_occupancy(placed, store, band, 1.0, run_with(1));
  EXPECT_EQ(image.origin, Eigen::Vector2d(0, -1));
  ASSERT_EQ(image.width, 6);
  ASSERT_EQ(image.height, 3);
  const std::vector<Occupancy> row(image.cells.begin() + 6, image.cells.begin() + 12);
  EXPECT_THAT(row, ElementsAre(Occupancy::unknown, Occupancy::free, Occupancy::free,
                               Occupancy::free, Occupancy::occupied, Occupancy::unknown));
  EXPECT_THROW(draw_occupancy(placed, store, HeightBand{1, 1, {0, 0}}, 1.0, run_with(1)),
               InputError);
}

// A floor 1.2 m below the sensor, and a few points of a cellar below it that are no floor.
TEST(OccupancyImage, FindsTheGroundUnderTheRobot) {
  std::vector<Eigen::Vector3f> points;
  for (int k = 0; k < 100; ++k) points.push_back({0.04f * static_cast<float>(k), 1, -1.2f});
  for (int k = 0; k < 100; ++k) points.push_back({1, 2, 0.02f * static_cast<float>(k)});
  points.push_back({3, 0, -4});
  for (int k = 0; k < 500; ++k) points.push_back({20, 0, -3});  // down the hill
  const auto store = store_of(points);
  const HeightBand band =
      find_height_band({{{0, Pose{{7, 8, 9}, Eigen::Quaterniond::Identity()}}}}, store);
  EXPECT_NEAR(band.min_m, -0.9, 1e-6);
  EXPECT_NEAR(band.max_m, 0.8, 1e-6);
  EXPECT_EQ(find_height_band({}, store), (HeightBand{0.3, 2.0, {0, 0}}));
}

// The lidar was switched on while it leaned, so its frame sees a level floor rise by 1 in 10 along
// x.
TEST(OccupancyImage, FindsTheSlopeOfTheFrame) {
  std::vector<Eigen::Vector3f> points;
  for (int x = -20; x <= 20; ++x)
    for (int y = -20; y <= 20; ++y) {
      const Eigen::Vector2f at(0.2f * static_cast<float>(x), 0.2f * static_cast<float>(y));
      points.push_back({at.x(), at.y(), -1 + 0.1f * at.x()});
    }
  for (int k = 0; k < 200; ++k) points.push_back({2, 1, -0.9f + 0.01f * static_cast<float>(k)});
  const auto store = store_of(points);
  const HeightBand band = find_height_band({{{0, Pose{}}}}, store);
  EXPECT_NEAR(band.min_m, -0.7, 0.02);
  EXPECT_NEAR(band.slope.x(), 0.1, 0.01);
  EXPECT_NEAR(band.slope.y(), 0, 0.01);
  // The floor at x = 4 is 0.6 m below the robot, but not in the band; a box 0.4 m over it is.
  const std::vector<PlacedObservation> placed = {{0, Pose{}}};
  const auto boxes = store_of({{4.5f, 0.5f, -0.55f}, {4.5f, -0.5f, -0.15f}});
  const OccupancyImage image = draw_occupancy(placed, boxes, band, 1.0, run_with(1));
  EXPECT_EQ(std::count(image.cells.begin(), image.cells.end(), Occupancy::occupied), 1);
}

TEST(SubmapCloud, IsTheMeanOfThePointsOfEachOccupiedCell) {
  const auto store = store_of({{2.0625f, 0.03125f, 0}, {2.03125f, 0.0625f, 0}});
  const std::vector<PlacedObservation> placed = {{0, Pose{}}};
  const auto ot = build_octree(placed, store, Space::se2, {0.125});
  const auto cloud = submap_cloud(placed, store, ot);
  EXPECT_THAT(cloud, ElementsAre(Eigen::Vector3f(2.046875f, 0.046875f, 0)));
  EXPECT_EQ(to_ply(cloud).size(), to_ply({}).size() + 12);
  EXPECT_THAT(to_pcd(cloud), HasSubstr("POINTS 1\nDATA binary\n"));
}

}  // namespace
}  // namespace hmt::submap
