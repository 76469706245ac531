// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hmt/submap/pipeline.hpp"
#include "park.hpp"
#include "real_data.hpp"
#include "run_command.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

TEST(LandmarkMap, IsComparedByTheInformationThatSubmapsShareAndByCopiesOfLandmarks) {
  const test::TemporaryFolder folder;
  const test::Park park(folder.path() / "park.txt");
  const auto result =
      test::run_hmtmap("partition " + (folder.path() / "park.txt").string() + " --compare --json");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto methods = result.json().at("methods");
  // Both rounds pass every place: by overlap they are in one submap, by time in two.
  EXPECT_LT(methods.at("ncut").at("information_loss"), methods.at("fixed").at("information_loss"));
  EXPECT_LT(methods.at("ncut").at("landmark_copies"), methods.at("fixed").at("landmark_copies"));
  EXPECT_GT(methods.at("ncut").at("landmark_information_loss"), 0);
}

TEST(LandmarkMap, HasNoWalls) {
  const test::TemporaryFolder folder;
  const test::Park park(folder.path() / "park.txt");
  const std::string map = (folder.path() / "park.hmt").string();
  ASSERT_EQ(test::run_hmtmap("map " + (folder.path() / "park.txt").string() + " -o " + map).code,
            0);
  for (const std::string& command :
       {"evaluate " + map + " --map-quality",
        "export " + map + " --only map -o " + (folder.path() / "out").string()}) {
    const auto result = test::run_hmtmap(command);
    EXPECT_EQ(result.code, 1) << command;
    EXPECT_THAT(result.err, testing::HasSubstr(command[1] == 'v' ? "needs scans" : "no surfaces"));
  }
}

TEST(LandmarkMap, OfVictoriaParkHasAllItsTrees) {
  HMT_REQUIRE_REAL_DATA("landmarks/victoria_park.txt");
  const test::TemporaryFolder folder;
  submap::Run run;
  run.threads = 2;
  const HybridMap map = build_map(test::data_dir() / "landmarks/victoria_park.txt",
                                  folder.path() / "park.hmt", {}, MapFile::Existing::resume, run)
                            .file.load_map();
  EXPECT_EQ(map.landmarks.size(), 151u);
  EXPECT_EQ(map.track.observations.size(), 6969u);
  EXPECT_GT(map.sightings.size(), 3560u);  // of 3640: a few contradict the rest
}

TEST(LandmarkMap, OfMrclamIsTrueToItsGroundTruth) {
  HMT_REQUIRE_REAL_DATA("landmarks/mrclam7/Robot1_Odometry.dat.gz");
  const test::TemporaryFolder folder;
  const std::string log = (test::data_dir() / "landmarks/mrclam7").string();
  for (const std::string robot : {"1", "2"}) {
    const std::string map = (folder.path() / (robot + ".hmt")).string();
    ASSERT_EQ(test::run_hmtmap("map " + log + " --robot " + robot + " -o " + map).code, 0);
    const auto errors =
        test::run_hmtmap("evaluate " + map + " --json --reference " + log + "/Robot" + robot +
                         "_Groundtruth.dat.gz --landmarks " + log + "/Landmark_Groundtruth.dat")
            .json();
    EXPECT_LE(errors.at("ate_rmse_m"), 0.10);
    EXPECT_LE(errors.at("landmark_rmse_m"), 0.08);
  }
}

}  // namespace
}  // namespace hmt::submap
