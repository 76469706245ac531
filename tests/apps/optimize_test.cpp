// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace hmt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

// 0 --1--> 1 --1--> 2 and 0 --2.3--> 2 along a line: each edge takes a third of the excess.
const char* const kTriangle =
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\nVERTEX_SE2 2 2 0 0\n"
    "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 0 1 0 0 1 0 1\n"
    "EDGE_SE2 0 2 2.3 0 0 1 0 0 1 0 1\n";

/// Vertices 10..19 along a line, a true loop 10 -> 13 and 15 -> 18, and a false one, 11 -> 17.
std::string line_with_a_false_loop() {
  std::string text;
  for (int i = 10; i < 20; ++i) text += "VERTEX_SE2 " + std::to_string(i) + " 0 0 0\n";
  const auto edge = [&](int from, int to, double x) {
    text += "EDGE_SE2 " + std::to_string(from) + " " + std::to_string(to) + " " +
            std::to_string(x) + " 0 0 100 0 0 100 0 100\n";
  };
  for (int i = 10; i < 19; ++i) edge(i, i + 1, 1);
  edge(10, 13, 3.01);
  edge(11, 17, -4);
  edge(15, 18, 2.99);
  return text;
}

class OptimizeCommand : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
    return (folder_.path() / name).string();
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  TemporaryFolder folder_;
};

TEST_F(OptimizeCommand, GivesTheFieldsThatToolsRelyOn) {
  const CommandResult result =
      run_hmtmap("optimize " + file("in.g2o", kTriangle) + " --json -o " + path("out.g2o"));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = result.json();
  EXPECT_EQ(json.at("poses"), 3);
  EXPECT_EQ(json.at("edges"), 3);
  EXPECT_NEAR(json.at("chi2_initial"), 0.09, 1e-12);
  EXPECT_NEAR(json.at("chi2"), 0.03, 1e-12);
  EXPECT_EQ(json.at("degrees_of_freedom"), 3);
  // The table of chi2 for three degrees of freedom: 2.5 % and 97.5 %.
  EXPECT_NEAR(json.at("chi2_95_percent")[0], 0.2158, 1e-4);
  EXPECT_NEAR(json.at("chi2_95_percent")[1], 9.3484, 1e-4);
  EXPECT_NEAR(json.at("chi2_p_value"), 0.9986, 1e-4);
  EXPECT_GT(json.at("condition"), 1.0);
  EXPECT_LT(json.at("gradient_norm"), 1e-8);
  EXPECT_EQ(json.at("termination"), "converged");
  EXPECT_EQ(json.at("start"), json.at("starts")[0].at("start"));
  EXPECT_EQ(json.at("inliers"), 3);
  EXPECT_GE(json.at("wall_s"), json.at("solve_s"));
  EXPECT_THAT(file_text(path("out.g2o")), HasSubstr("VERTEX_SE2 2 2."));
}

TEST_F(OptimizeCommand, JudgesEveryEdge) {
  const std::string input = file("in.g2o", line_with_a_false_loop());
  const CommandResult result = run_hmtmap("optimize " + input + " --robust gnc --json -o " +
                                          path("out.g2o") + " --verdicts " + path("v.csv"));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = result.json();
  ASSERT_EQ(json.at("outliers").size(), 1u);
  EXPECT_EQ(json.at("outliers")[0].at("edge"), 10);
  EXPECT_EQ(json.at("outliers")[0].at("from"), 11);
  EXPECT_EQ(json.at("outliers")[0].at("to"), 17);
  EXPECT_EQ(json.at("inliers"), 11);
  EXPECT_EQ(json.at("untrusted_start"), false);
  const std::string verdicts = file_text(path("v.csv"));
  EXPECT_THAT(verdicts, testing::StartsWith("edge,from,to,chi2,inlier\n0,10,11,"));
  EXPECT_THAT(verdicts, testing::ContainsRegex("\n10,11,17,[0-9.]+,0\n11,15,18,[0-9.e-]+,1\n$"));
}

// 0 --- 2 --- 1: the edge from 0 to 1 is missing, so that no chain of consecutive vertices is
// there.
TEST_F(OptimizeCommand, WarnsThatNothingIsTrusted) {
  const std::string input =
      file("in.g2o", "EDGE_SE2 0 2 1 0 0 1 0 0 1 0 1\nEDGE_SE2 2 1 1 0 0 1 0 0 1 0 1\n");
  const CommandResult result =
      run_hmtmap("optimize " + input + " --robust gnc --json -o " + path("out.g2o"));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("a guess that was checked"));
  EXPECT_EQ(result.json().at("untrusted_start"), true);
}

TEST_F(OptimizeCommand, KeepsTheBestOfSeveralStarts) {
  const CommandResult result = run_hmtmap("optimize " + file("in.g2o", line_with_a_false_loop()) +
                                          " --restarts 4 --json -o " + path("out.g2o"));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = result.json();
  ASSERT_EQ(json.at("starts").size(), 5u);
  for (const auto& start : json.at("starts")) EXPECT_LE(json.at("cost"), start.at("cost"));
}

TEST_F(OptimizeCommand, SaysWhatItDoesWithBadInformationAndOtherTags) {
  std::string text = kTriangle;
  for (int k = 0; k < 3000; ++k) text += "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 -1\n";
  text += "LANDMARK 1 2 3\nVERTEX_SE2 7 5 5 0\n";
  const CommandResult result =
      run_hmtmap("optimize " + file("in.g2o", text) + " --json -o " + path("out.g2o"));
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.err, HasSubstr("3000 information matrices have a negative eigenvalue"));
  EXPECT_THAT(result.err, HasSubstr("(lines 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, ...)"));
  EXPECT_THAT(result.err, HasSubstr("LANDMARK"));
  EXPECT_THAT(result.err, HasSubstr("2 components"));
  const auto json = result.json();
  EXPECT_EQ(json.at("input").at("weak_information").size(), 3000u);
  EXPECT_EQ(json.at("input").at("weak_information")[2999].at("line"), 3006);
  EXPECT_EQ(json.at("input").at("components"), 2);
}

TEST_F(OptimizeCommand, SolvesBySubmapsToTheSameOptimum) {
  const CommandResult result = run_hmtmap("optimize " + file("in.g2o", kTriangle) +
                                          " --method submaps --json -o " + path("out.g2o"));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NEAR(result.json().at("chi2"), 0.03, 1e-12);
  EXPECT_EQ(result.json().at("by_submaps").at("submaps"), 1);
  const CommandResult single = run_hmtmap("optimize " + file("one.g2o", "VERTEX_SE2 0 1 2 3\n") +
                                          " --json -o " + path("one_out.g2o"));
  ASSERT_EQ(single.code, 0) << single.err;
  EXPECT_EQ(single.json().at("termination"), "nothing_to_do");
}

TEST_F(OptimizeCommand, OverwritesNothingWithoutForceAndNamesTheDamage) {
  const std::string input = file("in.g2o", kTriangle);
  const std::string kept = file("kept.csv", "mine\n");
  const std::string command =
      "optimize " + input + " -o " + path("out.g2o") + " --verdicts " + kept;
  const CommandResult refused = run_hmtmap(command);
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(file_text(kept), "mine\n");
  EXPECT_FALSE(std::filesystem::exists(path("out.g2o")));
  EXPECT_EQ(run_hmtmap(command + " --force").code, 0);
  EXPECT_THAT(file_text(kept), Not(HasSubstr("mine")));
  const CommandResult damaged = run_hmtmap("optimize " + file("bad.g2o", "VERTEX_SE2 0 0 nan 0\n") +
                                           " -o " + path("none.g2o"));
  EXPECT_EQ(damaged.code, 1);
  EXPECT_THAT(damaged.err, HasSubstr("bad.g2o:1: VERTEX_SE2: 'nan'"));
  EXPECT_EQ(run_hmtmap("optimize " + input).code, 2);
}

}  // namespace
}  // namespace hmt::test
