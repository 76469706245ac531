// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run_command.hpp"

namespace hmt::test {
namespace {

using testing::HasSubstr;

constexpr const char* kScan = "FLASER 3 1 1 1  0 0 0  0 0 0  1.5 h 1\n";

class Check : public testing::Test {
 protected:
  std::string log(const std::string& name, const std::string& text) {
    std::ofstream(folder_.path() / name) << text;
    return (folder_.path() / name).string();
  }
  TemporaryFolder folder_;
};

TEST_F(Check, SaysFineWithCodeZero) {
  const std::string path = log("a.log", kScan + std::string("FLASER 3 1 1 1 0 0 0 0 0 0 2 h 1\n"));
  const CommandResult result = run_hmtmap("check " + path);
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out, HasSubstr("a.log: fine\n"));
  EXPECT_THAT(result.out, HasSubstr("observations  2 (2D)"));
}

TEST_F(Check, SaysLossesWithCodeThreeAndThePlace) {
  const std::string path = log("a.log", kScan + std::string("FLASER 3 1 1\n"));
  const CommandResult result = run_hmtmap("check " + path);
  EXPECT_EQ(result.code, 3);
  EXPECT_THAT(result.out, HasSubstr("usable with losses"));
  EXPECT_THAT(result.out, HasSubstr("first at " + path + ":2"));
}

TEST_F(Check, SaysUnusableWithCodeOneAndExaminesTheOtherLogs) {
  const std::string good = log("a.log", kScan);
  const std::string bad = log("b.log", "");
  const CommandResult result = run_hmtmap("--json check " + bad + " " + good);
  EXPECT_EQ(result.code, 1);
  const auto logs = result.json().at("logs");
  ASSERT_EQ(logs.size(), 2u);
  EXPECT_EQ(logs[0].at("verdict"), "unusable");
  EXPECT_EQ(logs[1].at("verdict"), "fine, with notes");
  EXPECT_EQ(logs[1].at("observations"), 1);
}

TEST_F(Check, NeedsALog) {
  EXPECT_EQ(run_hmtmap("check").code, 2);
}

TEST_F(Check, InfoTellsWhatIsInALog) {
  const std::string path = log("a.log", kScan);
  const CommandResult result = run_hmtmap("--json info " + path);
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.json().at("first_stamp_s"), 1.5);
  EXPECT_EQ(result.json().at("sensors").at(0).at("points"), 3);
  const CommandResult missing = run_hmtmap("info " + path + "x");
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.err, HasSubstr("no such file"));
}

}  // namespace
}  // namespace hmt::test
