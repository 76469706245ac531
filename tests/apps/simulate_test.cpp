// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hmt/submap/export/trajectory.hpp"
#include "read_log.hpp"
#include "run_command.hpp"

namespace hmt::test {
namespace {

using testing::HasSubstr;

TEST(Simulate, WritesALogAndItsTruth) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "a.log.gz";
  const CommandResult result = run_hmtmap("--json simulate rooms --seed 5 -o " + path);
  ASSERT_EQ(result.code, 0) << result.err;
  const auto scans = read_log(path);
  const auto truth = submap::read_tum(path + ".truth.tum");
  EXPECT_EQ(result.json().at("scans"), scans.size());
  ASSERT_EQ(scans.size(), truth.size());
  for (size_t i = 0; i < scans.size(); ++i) EXPECT_EQ(scans[i].stamp_s, truth[i].stamp_s);
}

TEST(Simulate, OverwritesOnlyByForce) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "a.log";
  std::ofstream(path) << "mine";
  const CommandResult result = run_hmtmap("simulate rooms -o " + path);
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("--force"));
  EXPECT_EQ(file_text(path), "mine");
  EXPECT_EQ(run_hmtmap("simulate rooms --force -o " + path).code, 0);
  EXPECT_GT(file_text(path).size(), 1000u);
}

TEST(Simulate, RefusesUnknownWorldsAndFolders) {
  EXPECT_EQ(run_hmtmap("simulate moon -o /tmp/never").code, 2);
  const CommandResult result = run_hmtmap("simulate rooms -o /no/such/folder/a.log");
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("/no/such/folder/a.log"));
}

}  // namespace
}  // namespace hmt::test
