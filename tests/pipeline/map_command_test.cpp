// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "run_command.hpp"

namespace hmt::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Every file below a folder with its bytes.
std::map<std::string, std::string> contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder)] = file_text(entry.path());
  return files;
}

class MapCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    ASSERT_EQ(run_hmtmap("simulate rooms -o " + path("log")).code, 0);
    ASSERT_EQ(run_hmtmap("map " + path("log") + " --threads 1 -o " + path("one.hmt")).code, 0);
    ASSERT_EQ(run_hmtmap("export " + path("one.hmt") + " -o " + path("one")).code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }
  static std::string path(const std::string& name) { return folder_->path() / name; }

  /// Exports a map and compares every file with that of the first run, which had one thread.
  static void expect_same_export(const std::string& map, const std::string& out) {
    ASSERT_EQ(run_hmtmap("export " + path(map) + " -o " + path(out)).code, 0);
    const auto expected = contents(path("one"));
    const auto actual = contents(path(out));
    ASSERT_GT(expected.size(), 8u);
    ASSERT_EQ(actual.size(), expected.size());
    for (const auto& [name, bytes] : expected) {
      // The report names the map file.
      if (name == "report.html") continue;
      EXPECT_TRUE(actual.at(name) == bytes) << name << " differs";
    }
  }

  inline static TemporaryFolder* folder_ = nullptr;
};

TEST_F(MapCommand, GivesTheSameBytesOnTwoThreads) {
  ASSERT_EQ(run_hmtmap("map " + path("log") + " --threads 2 -o " + path("two.hmt")).code, 0);
  expect_same_export("two.hmt", "two");
}

TEST_F(MapCommand, TakesLittleMemoryAndSaysWhereTheMapNeedsMore) {
  const auto small = run_hmtmap("map " + path("log") + " --max-memory 2M -o " + path("small.hmt"));
  ASSERT_EQ(small.code, 0);
  EXPECT_THAT(small.err, HasSubstr("more than the 2 MB that were allowed"));
  expect_same_export("small.hmt", "small");
  const auto large = run_hmtmap("map " + path("log") + " --max-memory 2G -o " + path("large.hmt"));
  ASSERT_EQ(large.code, 0);
  EXPECT_THAT(large.err, Not(HasSubstr("allowed")));
  EXPECT_EQ(run_hmtmap("map " + path("log") + " --max-memory much -o " + path("a.hmt")).code, 2);
}

TEST_F(MapCommand, GoesOnAfterAKillAndEndsWithTheSameMap) {
  // A shell kills the program after so many seconds, from while it reads to while it draws.
  for (const std::string& pause : std::vector<std::string>{"0.1", "0.3", "0.6", "1.0", "1.6"}) {
    const std::string map = path("killed" + pause + ".hmt");
    const std::string command = "timeout -s KILL " + pause + " '" HMTMAP_PROGRAM "' -q map " +
                                path("log") + " -o " + map + " 2>/dev/null";
    std::system(command.c_str());
    ASSERT_EQ(run_hmtmap("map " + path("log") + " -o " + map).code, 0) << "killed after " << pause;
    expect_same_export("killed" + pause + ".hmt", "killed" + pause);
  }
}

TEST_F(MapCommand, ReportsItsFiguresAsJson) {
  const CommandResult result = run_hmtmap("--json map " + path("log") + " -o " + path("json.hmt"));
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* field : {"observations", "keyframes", "submaps", "links", "loop_closures",
                            "information_loss", "wall_s", "cpu_s", "peak_rss_mb", "stages"})
    EXPECT_TRUE(result.json().contains(field)) << field;
  EXPECT_TRUE(result.json().at("stages").contains("track"));
}

TEST_F(MapCommand, RefusesToGoOnWithOtherOptions) {
  const CommandResult result =
      run_hmtmap("map " + path("log") + " --tau 0.4 -o " + path("one.hmt"));
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("one.hmt"));
  EXPECT_THAT(result.err, HasSubstr("--force"));
}

TEST_F(MapCommand, PartitionsOnItsWayAndTellsSo) {
  const CommandResult result =
      run_hmtmap("-v --json map " + path("log") + " --sequential -o " + path("way.hmt"));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("keyframe 0: entered area 0 of 1 keyframes"));
  EXPECT_THAT(result.err, HasSubstr(": closed area 0 of "));
  // Places that the robot comes back to are areas anew.
  const CommandResult whole = run_hmtmap("--json info " + path("one.hmt"));
  EXPECT_GE(result.json().at("submaps").get<size_t>(), whole.json().at("submaps").size());
  const CommandResult info = run_hmtmap("--json info " + path("way.hmt"));
  EXPECT_EQ(info.json().at("options").at("partition").at("sequential"), true);
  EXPECT_EQ(run_hmtmap("map " + path("log") + " -o " + path("way.hmt")).code, 1);
}

TEST_F(MapCommand, RefusesWhatIsNotALog) {
  std::ofstream(path("empty"));
  std::ofstream(path("junk"), std::ios::binary) << std::string(1000, '\xff');
  for (const std::string& name : std::vector<std::string>{"empty", "junk", "missing", "."}) {
    const CommandResult result = run_hmtmap("map " + path(name) + " -o " + path("never.hmt"));
    EXPECT_EQ(result.code, 1) << name;
    EXPECT_THAT(result.err, HasSubstr("error")) << name;
    EXPECT_FALSE(std::filesystem::exists(path("never.hmt"))) << name;
  }
  // Neither does it cost the map that it was to replace.
  std::ofstream(path("old.hmt")) << "a map";
  EXPECT_EQ(run_hmtmap("map " + path("junk") + " --force -o " + path("old.hmt")).code, 1);
  EXPECT_EQ(file_text(path("old.hmt")), "a map");
}

TEST_F(MapCommand, MapsALogOfOneScanAndOneThatJumps) {
  std::ofstream(path("single")) << "FLASER 5 1 1 1 1 1 0 0 0 0 0 0 1 host 1\n";
  EXPECT_EQ(run_hmtmap("map " + path("single") + " -o " + path("single.hmt")).code, 0);
  EXPECT_EQ(run_hmtmap("export " + path("single.hmt") + " -o " + path("single.d")).code, 0);
  std::ofstream jump(path("jump"));
  for (int k = 0; k < 6; ++k) {
    const int x = k < 3 ? k : 100 + k;
    jump << "FLASER 5 2 2 2 2 2 " << x << " 0 0 " << x << " 0 0 " << k << " host " << k << "\n";
  }
  jump.close();
  EXPECT_EQ(run_hmtmap("map " + path("jump") + " -o " + path("jump.hmt")).code, 0);
}

TEST_F(MapCommand, SaysWhatItLeftOutWithExitCode3) {
  const std::string whole = file_text(path("log"));
  std::ofstream(path("cut"), std::ios::binary) << whole.substr(0, whole.size() / 2);
  const CommandResult result = run_hmtmap("map " + path("cut") + " -o " + path("cut.hmt"));
  EXPECT_EQ(result.code, 3) << result.err;
  EXPECT_THAT(result.err, HasSubstr("warning"));
}

TEST_F(MapCommand, SaysWhenTheDiskIsFullOrTheFolderIsMissing) {
  EXPECT_EQ(run_hmtmap("map " + path("log") + " -o /no/such/folder/a.hmt").code, 1);
  EXPECT_EQ(run_hmtmap("map " + path("log") + " -o /dev/full").code, 1);
}

TEST_F(MapCommand, RefusesADamagedMap) {
  std::string bytes = file_text(path("one.hmt"));
  for (size_t k = bytes.size() / 3; k < bytes.size() / 3 + 5000 && k < bytes.size(); ++k)
    bytes[k] = '\x5a';
  std::ofstream(path("damaged.hmt"), std::ios::binary) << bytes;
  const CommandResult result =
      run_hmtmap("export " + path("damaged.hmt") + " -o " + path("damaged"));
  EXPECT_EQ(result.code, 1);
  EXPECT_THAT(result.err, HasSubstr("damaged.hmt"));
}

}  // namespace
}  // namespace hmt::test
