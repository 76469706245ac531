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

TEST_F(PartitionCommand, SaysWhatIsWrongWithTheMatrix) {
  const CommandResult result =
      run_hmtmap("partition " + file("bad.mtx",
                                     "%%MatrixMarket matrix coordinate real symmetric\n"
                                     "2 2 1\n2 1 nan\n"));
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("bad.mtx:3: entry (row 2, column 1)"));
}

}  // namespace
}  // namespace hmt::test
