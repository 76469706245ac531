// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace hmt::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

// Two triangles of unit arcs, joined by an arc of 0.1 between nodes 3 and 4 (from 1).
const char* const kTwoTriangles =
    "%%MatrixMarket matrix coordinate real symmetric\n6 6 7\n"
    "2 1 1\n3 1 1\n3 2 1\n4 3 0.1\n5 4 1\n6 4 1\n6 5 1\n";

class PartitionCommand : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
    return (folder_.path() / name).string();
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  TemporaryFolder folder_;
  std::string omega_ = file("omega.mtx", kTwoTriangles);
};

TEST_F(PartitionCommand, GivesTheFieldsThatToolsRelyOnAndALabelALine) {
  const CommandResult result =
      run_hmtmap("partition " + omega_ + " --json --tau 0.5 -o " + path("labels.txt"));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = result.json();
  EXPECT_EQ(json.at("nodes"), 6);
  EXPECT_EQ(json.at("groups"), 2);
  EXPECT_EQ(json.at("sizes"), (std::vector<int>{3, 3}));
  EXPECT_NEAR(json.at("kway_ncut"), 0.2 / 6.1, 1e-12);
  EXPECT_NEAR(json.at("top_ncut"), 0.2 / 6.1, 1e-12);
  EXPECT_GE(json.at("wall_s"), 0.0);
  EXPECT_EQ(json.at("bisections").size(), 1u);
  EXPECT_EQ(file_text(path("labels.txt")), "0\n0\n0\n1\n1\n1\n");
}

TEST_F(PartitionCommand, OverwritesNothingWithoutForce) {
  const std::string kept = file("labels.txt", "mine\n");
  const std::string command = "partition " + omega_ + " -o " + kept;
  const CommandResult refused = run_hmtmap(command);
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.err, HasSubstr("--force"));
  EXPECT_EQ(file_text(kept), "mine\n");
  EXPECT_EQ(run_hmtmap(command + " --force").code, 0);
  EXPECT_EQ(file_text(kept), "0\n0\n0\n1\n1\n1\n");
}

TEST_F(PartitionCommand, MakesTheGroupsThatAreAsked) {
  for (const char* method : {"ncut", "fixed", "metis"}) {
    const CommandResult result =
        run_hmtmap("partition " + omega_ + " --groups 2 --json --method " + method);
    EXPECT_EQ(result.json().at("sizes"), (std::vector<int>{3, 3})) << method;
  }
  EXPECT_EQ(run_hmtmap("partition " + omega_ + " --groups 7").code, 1);
  EXPECT_EQ(run_hmtmap("partition " + omega_ + " --groups 2 --tau 0.5").code, 2);
  EXPECT_EQ(run_hmtmap("partition " + omega_ + " --threshold median").code, 2);
}

TEST_F(PartitionCommand, SweepsTauIntoATableAndCsv) {
  const CommandResult result =
      run_hmtmap("partition " + omega_ + " --sweep-tau --json --csv " + path("sweep.csv"));
  ASSERT_EQ(result.code, 0) << result.err;
  const auto sweep = result.json().at("sweep");
  ASSERT_EQ(sweep.size(), 30u);
  EXPECT_EQ(sweep.at(9).at("groups"), 2);
  EXPECT_NEAR(sweep.at(29).at("tau"), 1.5, 1e-9);
  EXPECT_THAT(file_text(path("sweep.csv")),
              StartsWith("tau,groups,smallest,median,largest,kway_ncut\n0.05,2,3,3,3,"));
}

TEST_F(PartitionCommand, ComparesMethodsAtTheSameNumberOfGroups) {
  const auto methods = run_hmtmap("partition " + omega_ + " --compare --json").json().at("methods");
  for (const char* method : {"ncut", "fixed", "metis"}) {
    EXPECT_EQ(methods.at(method).at("groups"), 2);
    EXPECT_EQ(methods.at(method).at("adjusted_rand_index"), 1);
  }
}

TEST_F(PartitionCommand, RefusesOfAMatrixWhatItCannotKnow) {
  for (const char* option : {"--max-loss 0.01", "--method distance --every 5",
                             "--method time --groups 2", "--method fixed", "--every 3"}) {
    const CommandResult result = run_hmtmap("partition " + omega_ + " " + option);
    EXPECT_EQ(result.code, 1) << option;
    EXPECT_THAT(result.err, HasSubstr("error: ")) << option;
  }
}

TEST_F(PartitionCommand, RefusesOptionsThatContradictEachOther) {
  for (const char* options :
       {"--max-loss 0.1 --tau 0.5", "--method fixed --every 2 --groups 2", "--sweep-tau --tau 0.5",
        "--sweep-tau --compare", "--compare --method metis"})
    EXPECT_EQ(run_hmtmap("partition " + omega_ + " " + options).code, 2) << options;
}

TEST_F(PartitionCommand, CutsEverySoManyNodes) {
  const CommandResult result =
      run_hmtmap("partition " + omega_ + " --method fixed --every 4 --json");
  EXPECT_EQ(result.json().at("sizes"), (std::vector<int>{4, 2}));
}

TEST_F(PartitionCommand, SaysWhatIsWrongWithTheMatrix) {
  const CommandResult result =
      run_hmtmap("partition " + file("bad.mtx",
                                     "%%MatrixMarket matrix coordinate real symmetric\n"
                                     "2 2 1\n2 1 nan\n"));
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("bad.mtx:3: entry (row 2, column 1)"));
}

/// A map of the simulated rooms, made once.
class PartitionOfMap : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    ASSERT_EQ(run_hmtmap("simulate rooms -o " + path("log")).code, 0);
    ASSERT_EQ(run_hmtmap("map " + path("log") + " -o " + path("map.hmt")).code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string path(const std::string& name) { return folder_->path() / name; }

  static nlohmann::json partition(const std::string& options) {
    const CommandResult result = run_hmtmap("partition " + path("map.hmt") + " --json " + options);
    EXPECT_EQ(result.code, 0) << options << "\n" << result.err;
    return result.json();
  }

  inline static TemporaryFolder* folder_ = nullptr;
};

TEST_F(PartitionOfMap, LosesMoreInformationTheFurtherItIsCut) {
  const auto sweep = partition("--sweep-tau --csv " + path("sweep.csv")).at("sweep");
  for (size_t i = 1; i < sweep.size(); ++i)
    EXPECT_GE(sweep[i].at("information_loss"), sweep[i - 1].at("information_loss"));
  EXPECT_GT(sweep.back().at("information_loss"), 0.05);
  EXPECT_THAT(file_text(path("sweep.csv")),
              StartsWith("tau,groups,smallest,median,largest,kway_ncut,information_loss\n"));
}

TEST_F(PartitionOfMap, KeepsBelowTheGreatestLossByTheLargestTau) {
  const auto within = partition("--max-loss 0.03");
  EXPECT_LT(within.at("information_loss"), 0.03);
  const double next = within.at("tau").get<double>() + 0.01;
  EXPECT_GE(partition("--tau " + std::to_string(next)).at("information_loss"), 0.03);
}

TEST_F(PartitionOfMap, CutsEverySoManyMetresOrSeconds) {
  // 63 m of path in 35 s, less what lies before the first and after the last keyframe.
  const int groups = partition("--method distance --every 10").at("groups");
  EXPECT_GE(groups, 6);
  EXPECT_LE(groups, 7);
  EXPECT_EQ(partition("--method time --groups 4").at("groups"), 4);
  EXPECT_EQ(partition("--method distance --groups 4").at("groups"), 4);
}

TEST_F(PartitionOfMap, LosesLessThanOtherMethodsWithAsManyGroups) {
  const auto methods = partition("--groups 5 --compare").at("methods");
  ASSERT_EQ(methods.size(), 5u);
  for (const char* other : {"fixed", "distance", "time", "metis"}) {
    EXPECT_LT(methods.at("ncut").at("information_loss"), methods.at(other).at("information_loss"))
        << other;
    EXPECT_LT(methods.at("ncut").at("kway_ncut"), methods.at(other).at("kway_ncut")) << other;
  }
}

TEST_F(PartitionOfMap, TakesALogAsItsMap) {
  const CommandResult of_log = run_hmtmap("partition " + path("log") + " --json -q");
  ASSERT_EQ(of_log.code, 0) << of_log.err;
  EXPECT_EQ(of_log.json().at("sizes"), partition("").at("sizes"));
}

}  // namespace
}  // namespace hmt::test
