// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace hmt::test {
namespace {

using testing::HasSubstr;

class Evaluate : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
    return (folder_.path() / name).string();
  }
  TemporaryFolder folder_;
  std::string trajectory_ = file("a.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 2 0 0 0 0 0 1\n");
};

TEST_F(Evaluate, GivesTheFieldsThatToolsRelyOn) {
  const std::string relations =
      file("r", "1 2 1.5 0 0 0 0 0\n2 3 1 0 0 0 0 0.017453292519943295\n5 6 1 0 0 0 0 0\n");
  const CommandResult result = run_hmtmap("--json evaluate " + trajectory_ + " --relations " +
                                          relations + " --reference " + trajectory_);
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = result.json();
  EXPECT_EQ(json.at("relations_used"), 2);
  EXPECT_NEAR(json.at("trans_mean_m"), 0.25, 1e-12);
  EXPECT_NEAR(json.at("trans_std_m"), 0.25, 1e-12);
  EXPECT_NEAR(json.at("rot_mean_deg"), 0.5, 1e-9);
  EXPECT_NEAR(json.at("rot_std_deg"), 0.5, 1e-9);
  EXPECT_NEAR(json.at("ate_rmse_m"), 0, 1e-9);
}

TEST_F(Evaluate, NeedsATruth) {
  EXPECT_EQ(run_hmtmap("evaluate " + trajectory_).code, 2);
}

TEST_F(Evaluate, RefusesWhatDoesNotFit) {
  const std::string other = file("b.tum", "8 0 0 0 0 0 0 1\n9 1 0 0 0 0 0 1\n");
  const CommandResult result = run_hmtmap("evaluate " + trajectory_ + " --reference " + other);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("0 of the 2 stamps"));
  EXPECT_EQ(run_hmtmap("evaluate " + trajectory_ + " --relations " + trajectory_ + "x").code, 1);
}

}  // namespace
}  // namespace hmt::test
