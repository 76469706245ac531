// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Logs that were recorded into several files, given one after the other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "hmt/submap/log/log_reader.hpp"
#include "recordings/recording_writers.hpp"
#include "recordings/simulated_messages.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct Contents {
  std::vector<Observation> observations;
  LogReport report;
};

class LogInParts : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }
  fs::path write(const std::string& name, std::string_view bytes) const {
    test::write_file(path(name), bytes);
    return path(name);
  }
  /// Scans `begin` to `end` of a drive of a metre per second along x, as CARMEN text.
  fs::path carmen(const std::string& name, int begin, int end) const {
    std::string text;
    for (int k = begin; k < end; ++k) {
      const std::string pose = std::to_string(k) + " 0 0 ";
      text += "FLASER 3 1.0 2.0 3.0 " + pose + pose + std::to_string(k) + " host " +
              std::to_string(k) + "\n";
    }
    return write(name, text);
  }
  static Contents read(const fs::path& first, const std::vector<fs::path>& further) {
    LogOptions options;
    options.further_parts = further;
    const auto log = open_log(first, options);
    Contents contents;
    while (auto observation = log->next()) contents.observations.push_back(std::move(*observation));
    contents.report = log->report();
    EXPECT_EQ(log->bytes_read(), log->bytes_total());
    return contents;
  }
  static std::string reason(const fs::path& first, const std::vector<fs::path>& further) {
    try {
      read(first, further);
    } catch (const graph::InputError& error) {
      return error.what();
    }
    return "";
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(LogInParts, CarmenPartsAreReadAsTheWhole) {
  const Contents whole = read(carmen("whole", 0, 30), {});
  const Contents parts = read(carmen("a", 0, 11), {carmen("b", 11, 12), carmen("c", 12, 30)});
  ASSERT_EQ(whole.observations.size(), 30u);
  EXPECT_EQ(parts.observations, whole.observations);
  EXPECT_EQ(parts.report, whole.report);
}

TEST_F(LogInParts, BagsAreReadAsTheWhole) {
  auto messages = test::simulated_messages({"rooms", 3, 1}, Wire::ros1, 60);
  const fs::path whole = write("whole.bag", test::ros1_bag(messages, {}));
  // Frames of the mount are told in the first part only.
  const auto middle = messages.begin() + static_cast<std::ptrdiff_t>(messages.size() / 2);
  const fs::path a = write("a.bag", test::ros1_bag({messages.begin(), middle}, {}));
  const fs::path b = write("b.bag", test::ros1_bag({middle, messages.end()}, {}));
  const Contents expected = read(whole, {});
  ASSERT_GT(expected.observations.size(), 50u);
  EXPECT_EQ(read(a, {b}).observations, expected.observations);
}

TEST_F(LogInParts, TellWherePartsAreOutOfOrder) {
  const Contents parts = read(carmen("b", 11, 30), {carmen("a", 0, 11)});
  EXPECT_EQ(parts.observations.size(), 30u);
  EXPECT_EQ(parts.report.notes.at("stamps run backwards"), 1);
  EXPECT_EQ(parts.report.first_places.at("stamps run backwards"), path("a").string());
}

TEST_F(LogInParts, APartThatCannotBeReadIsALoss) {
  const Contents parts = read(carmen("a", 0, 11), {write("b", "FLASER\n"), carmen("c", 12, 30)});
  EXPECT_EQ(parts.observations.size(), 29u);
  EXPECT_EQ(parts.report.losses.at("parts that cannot be read"), 1);
  EXPECT_THAT(parts.report.first_places.at("parts that cannot be read"), HasSubstr("b: "));
}

TEST_F(LogInParts, RefuseAtOnceWhatDoesNotGoTogether) {
  const fs::path text = carmen("a", 0, 11);
  const fs::path bag =
      write("b.bag", test::ros1_bag(test::simulated_messages({"rooms", 3, 1}, Wire::ros1, 3), {}));
  EXPECT_THAT(reason(text, {path("missing")}), HasSubstr("missing"));
  EXPECT_THAT(reason(text, {bag}), HasSubstr("b.bag: not of the format of"));
  const fs::path landmarks = write("c", "ODOMETRY 0 1 1 0 0 1 0 0 1 0 1\n");
  EXPECT_THAT(reason(landmarks, {text}), HasSubstr("only CARMEN logs and recordings of ROS"));
}

}  // namespace
}  // namespace hmt::submap
