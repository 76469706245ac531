// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "run_command.hpp"

namespace hmt::test {
namespace {

using testing::HasSubstr;

/// A map of a corridor with equal rooms, which the robot drives there and back.
class LoopsCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    ASSERT_EQ(run_hmtmap("simulate symmetric -o " + path("log")).code, 0);
    ASSERT_EQ(run_hmtmap("map " + path("log") + " -o " + path("map.hmt")).code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string path(const std::string& name) { return folder_->path() / name; }
  static nlohmann::json loops(const std::string& arguments) {
    const CommandResult result = run_hmtmap("--json loops " + arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.json().at("loops");
  }
  static int first_with(const nlohmann::json& loops, const std::string& verdict) {
    for (const auto& loop : loops)
      if (loop.at("verdict") == verdict) return loop.at("id");
    return -1;
  }

  inline static TemporaryFolder* folder_ = nullptr;
};

TEST_F(LoopsCommand, ListsEveryCandidateWithItsEffect) {
  const auto all = loops(path("map.hmt"));
  ASSERT_GT(all.size(), 10u);
  const int accepted = first_with(all, "accepted");
  ASSERT_GE(accepted, 0);
  EXPECT_GT(all[static_cast<size_t>(accepted)].at("chi2_rise"), 0);
  EXPECT_GT(all[static_cast<size_t>(accepted)].at("predicted_sigma_m"), 0);
  EXPECT_THAT(run_hmtmap("loops " + path("map.hmt")).out, HasSubstr("accepted"));
}

TEST_F(LoopsCommand, RecordsDecisionsAndOptimizesAgain) {
  std::filesystem::copy(path("map.hmt"), path("decided.hmt"));
  const auto before = loops(path("map.hmt"));
  const int rejected = first_with(before, "accepted");
  const int confirmed = first_with(before, "ambiguous");
  ASSERT_GE(rejected, 0);
  ASSERT_GE(confirmed, 0);
  const auto after = loops(path("decided.hmt") + " --reject " + std::to_string(rejected) +
                           " --accept " + std::to_string(confirmed));
  ASSERT_GE(after.size(), before.size());
  for (size_t k = 0; k < before.size(); ++k) EXPECT_EQ(after[k].at("id"), before[k].at("id"));
  EXPECT_EQ(after[static_cast<size_t>(rejected)].at("verdict"), "rejected");
  EXPECT_EQ(after[static_cast<size_t>(rejected)].at("b"),
            before[static_cast<size_t>(rejected)].at("b"));
  EXPECT_EQ(after[static_cast<size_t>(confirmed)].at("verdict"), "confirmed");
  // The map is finished, and the decisions are in the file.
  EXPECT_EQ(loops(path("decided.hmt")), after);
  EXPECT_EQ(run_hmtmap("export " + path("decided.hmt") + " -o " + path("decided")).code, 0);
  EXPECT_EQ(run_hmtmap("map " + path("log") + " -o " + path("decided.hmt")).code, 0);
  EXPECT_EQ(loops(path("decided.hmt")), after);
}

TEST_F(LoopsCommand, RefusesWhatMakesNoSense) {
  const CommandResult unknown = run_hmtmap("loops " + path("map.hmt") + " --reject 100000");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("there is no loop candidate 100000"));
  EXPECT_EQ(run_hmtmap("loops " + path("map.hmt") + " --reject 1 --accept 1").code, 1);
}

TEST_F(LoopsCommand, OneSubmapIsOptimizedAndNoOtherTouched) {
  std::filesystem::copy(path("map.hmt"), path("one.hmt"));
  const CommandResult result = run_hmtmap("--json optimize " + path("one.hmt") + " --submap 3");
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_LE(result.json().at("chi2"), result.json().at("chi2_initial"));
  for (const char* name : {"map", "one"})
    ASSERT_EQ(run_hmtmap("export " + path(std::string(name) + ".hmt") + " -o " + path(name)).code,
              0);
  int same = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path("map") + "/submaps")) {
    const std::string name = entry.path().filename();
    if (name.starts_with("0003.")) continue;
    EXPECT_TRUE(file_text(entry.path()) == file_text(path("one") + "/submaps/" + name)) << name;
    ++same;
  }
  EXPECT_GT(same, 10);
  EXPECT_TRUE(file_text(path("map") + "/topology.json") ==
              file_text(path("one") + "/topology.json"));
  EXPECT_FALSE(file_text(path("map") + "/trajectory.tum") ==
               file_text(path("one") + "/trajectory.tum"));
  EXPECT_EQ(run_hmtmap("optimize " + path("one.hmt") + " --submap 9999").code, 1);
}

TEST_F(LoopsCommand, ARouteLeadsBackAlongTheCorridor) {
  const CommandResult result =
      run_hmtmap("--json route " + path("map.hmt") + " --from 0,0 --to 30,0");
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = result.json();
  EXPECT_LT(json.at("start_distance_m"), 0.5);
  EXPECT_LT(json.at("goal_distance_m"), 1);
  EXPECT_NEAR(json.at("length_m"), 30, 2);
  EXPECT_EQ(json.at("steps").front().at("sigma_position_m"), 0);
  EXPECT_GT(json.at("steps").back().at("sigma_position_m"), 1e-3);
  EXPECT_LT(json.at("steps").back().at("sigma_position_m"), 0.5);
  EXPECT_EQ(run_hmtmap("route " + path("map.hmt") + " --from 0,nan --to 30,0").code, 1);
  EXPECT_EQ(run_hmtmap("route " + path("map.hmt") + " --from 0 --to 30,0").code, 2);
}

TEST_F(LoopsCommand, ByMapSaysHowThickTheWallsAre) {
  const CommandResult result = run_hmtmap("--json evaluate " + path("map.hmt") +
                                          " --map-quality --reference " + path("log.truth.tum"));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = result.json();
  // Noise of 1 cm and steps of 1 cm: 2 sqrt(0.01^2 + 0.01^2 / 12) = 0.021 m at the true poses where
  // beams meet a wall squarely, less where they slant.
  EXPECT_GT(json.at("reference_map_quality").at("mean_wall_thickness_m"), 0.012);
  EXPECT_LT(json.at("reference_map_quality").at("mean_wall_thickness_m"), 0.021);
  EXPECT_LT(json.at("map_quality").at("mean_wall_thickness_m"), 0.03);
  EXPECT_EQ(json.at("map_quality").at("scans"), json.at("reference_map_quality").at("scans"));
}

}  // namespace
}  // namespace hmt::test
