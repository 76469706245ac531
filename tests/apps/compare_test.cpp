// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace hmt::test {
namespace {

class Compare : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
    return (folder_.path() / name).string();
  }
  TemporaryFolder folder_;
};

TEST_F(Compare, TrajectoriesByTheirShape) {
  const std::string a = file("a.tum", "1 0 0 0 0 0 0 1\n2 4 0 0 0 0 0 1\n");
  const std::string b = file("b.tum", "1 5 5 0 0 0 0 1\n2 5 7 0 0 0 0 1\n3 5 9 0 0 0 0 1\n");
  const CommandResult result = run_hmtmap("--json compare " + a + " " + b);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.json().at("kind"), "trajectory");
  EXPECT_EQ(result.json().at("matched"), 2);
  EXPECT_NEAR(result.json().at("ate_rmse_m"), 1, 1e-9);
}

TEST_F(Compare, PartitionsByTheirGroups) {
  const std::string a = file("a.txt", "0\n0\n1\n1\n");
  const std::string b = file("b.txt", "7\n7\n3\n3\n");
  const CommandResult result = run_hmtmap("--json compare " + a + " " + b);
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.json().at("kind"), "partition");
  EXPECT_EQ(result.json().at("adjusted_rand_index"), 1);
}

TEST_F(Compare, RefusesAPartitionWithATrajectory) {
  const std::string a = file("a.tum", "1 0 0 0 0 0 0 1\n2 4 0 0 0 0 0 1\n");
  const std::string b = file("b.txt", "0\n1\n");
  const CommandResult result = run_hmtmap("compare " + a + " " + b);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, testing::HasSubstr("a.tum"));
}

}  // namespace
}  // namespace hmt::test
