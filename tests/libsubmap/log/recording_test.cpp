// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Containers: what a bag, an MCAP file or a database gives of what was put into it, whole and
// damaged.
#include "log/recording/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "log/recording/decompress.hpp"
#include "recordings/recording_writers.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

using test::SampleMessage;
using testing::HasSubstr;

/// Forty messages on two topics, each with its number as text.
std::vector<SampleMessage> samples() {
  std::vector<SampleMessage> messages;
  for (int k = 0; k < 40; ++k)
    messages.push_back({k % 2 == 0 ? "/a" : "/b",
                        k % 2 == 0 ? "std_msgs/String" : "nav_msgs/Odometry",
                        int64_t{1'500'000'000'000'000'000} + k, "message " + std::to_string(k)});
  return messages;
}

struct Contents {
  std::vector<std::string> data;
  std::vector<RecordedTopic> topics;
  LogReport report;
};

class RecordingFile : public testing::Test {
 protected:
  Contents read(const std::filesystem::path& path) const {
    const auto recording = open_recording(path);
    Contents contents;
    while (const auto message = recording->next()) {
      contents.data.emplace_back(message->data);
      const size_t k = contents.data.size() - 1;
      EXPECT_LT(message->topic, recording->topics().size());
      if (k < samples().size() && recording->report().losses.empty()) {
        EXPECT_EQ(message->received_ns, samples()[k].received_ns);
      }
    }
    contents.topics = recording->topics();
    contents.report = recording->report();
    return contents;
  }
  Contents read_bytes(std::string_view bytes) const {
    test::write_file(path(), bytes);
    return read(path());
  }
  std::filesystem::path path() const { return folder_.path() / "file"; }

  /// All 40 messages, in order, nothing lost.
  static void expect_all(const Contents& contents) {
    ASSERT_EQ(contents.data.size(), 40u);
    for (size_t k = 0; k < 40; ++k) EXPECT_EQ(contents.data[k], samples()[k].bytes);
    ASSERT_EQ(contents.topics.size(), 2u);
    EXPECT_EQ(contents.topics[0].name, "/a");
    EXPECT_EQ(contents.topics[1].kind(), MessageKind::odometry);
    EXPECT_TRUE(contents.report.losses.empty());
  }

  test::TemporaryFolder folder_;
};

TEST_F(RecordingFile, BagsOfAllCompressionsGiveWhatWasWritten) {
  for (const char* codec : {"none", "lz4", "bz2"})
    expect_all(read_bytes(ros1_bag(samples(), {codec, 7})));
  expect_all(read_bytes(ros1_bag(samples(), {"none", 0})));
}

TEST_F(RecordingFile, McapFilesOfAllCompressionsGiveWhatWasWritten) {
  for (const char* codec : {"none", "lz4", "zstd"})
    expect_all(read_bytes(mcap_file(samples(), {codec, 7})));
  expect_all(read_bytes(mcap_file(samples(), {"none", 0})));
}

TEST_F(RecordingFile, SqliteBagsGiveWhatWasWritten) {
  test::write_sqlite_bag(path(), samples());
  expect_all(read(path()));
}

TEST_F(RecordingFile, FilesThatWereNotClosedAreReadToTheirEnd) {
  const Contents contents = read_bytes(mcap_file(samples(), {"zstd", 7}, false));
  EXPECT_EQ(contents.data.size(), 40u);
  EXPECT_TRUE(contents.report.losses.empty());
  EXPECT_FALSE(contents.report.notes.empty());
}

TEST_F(RecordingFile, AFolderOfPartsIsReadInNaturalOrder) {
  const auto all = samples();
  const std::vector<SampleMessage> first(all.begin(), all.begin() + 20);
  const std::vector<SampleMessage> second(all.begin() + 20, all.end());
  std::filesystem::create_directory(folder_.path() / "bag");
  test::write_sqlite_bag(folder_.path() / "bag/x_9.db3", first);
  test::write_sqlite_bag(folder_.path() / "bag/x_10.db3", second);
  test::write_file(folder_.path() / "bag/metadata.yaml", "version: 5");
  expect_all(read(folder_.path() / "bag"));
}

// Cut at any byte, a recording gives its first messages and says that it was cut, but for the few
// places between two records, where nobody can know.
void expect_prefixes(const std::string& whole,
                     const std::function<Contents(std::string_view)>& read, size_t first_size) {
  size_t silent = 0;
  for (size_t size = first_size; size < whole.size(); size += 7) {
    const Contents contents = read(std::string_view(whole).substr(0, size));
    ASSERT_LE(contents.data.size(), 40u);
    for (size_t k = 0; k < contents.data.size(); ++k)
      ASSERT_EQ(contents.data[k], samples()[k].bytes);
    if (contents.report.losses.empty()) ++silent;
  }
  EXPECT_LT(silent, 60u);
}

TEST_F(RecordingFile, CutBagsGiveTheirFirstMessages) {
  expect_prefixes(
      ros1_bag(samples(), {"none", 7}), [&](auto bytes) { return read_bytes(bytes); }, 14);
}

TEST_F(RecordingFile, CutMcapFilesGiveTheirFirstMessages) {
  expect_prefixes(
      mcap_file(samples(), {"lz4", 7}), [&](auto bytes) { return read_bytes(bytes); }, 9);
}

TEST_F(RecordingFile, CutSqliteBagsGiveTheirFirstMessages) {
  auto all = samples();
  for (auto& message : all) message.bytes.resize(2000, ' ');
  test::write_sqlite_bag(path(), all);
  std::filesystem::resize_file(path(), std::filesystem::file_size(path()) / 2);
  const Contents contents = read(path());
  EXPECT_GT(contents.data.size(), 5u);
  EXPECT_LT(contents.data.size(), 40u);
  for (size_t k = 0; k < contents.data.size(); ++k) EXPECT_EQ(contents.data[k], all[k].bytes);
  EXPECT_FALSE(contents.report.losses.empty());
}

TEST_F(RecordingFile, ADamagedChunkCostsNoOther) {
  std::string bag = ros1_bag(samples(), {"bz2", 10});
  bag[bag.find("BZh", bag.find("BZh") + 3) + 60] ^= 0x55;  // in the second chunk
  const Contents contents = read_bytes(bag);
  EXPECT_EQ(contents.data.size(), 30u);
  EXPECT_THAT(contents.report.losses.begin()->first, HasSubstr("damaged"));
}

TEST_F(RecordingFile, AWrongChecksumCostsItsChunk) {
  std::string file = mcap_file(samples(), {"none", 10});
  file[file.find("message 15")] = 'M';
  const Contents contents = read_bytes(file);
  EXPECT_EQ(contents.data.size(), 30u);
  EXPECT_THAT(contents.report.losses.begin()->first, HasSubstr("wrong checksum"));
}

TEST_F(RecordingFile, LengthsThatLieAreRefusedWithoutMemory) {
  std::string file = mcap_file(samples(), {"none", 0});
  const size_t first = file.find("message 0") - 22 - 8;
  file.replace(first, 8, std::string("\xff\xff\xff\xff\xff\xff\xff\x7f", 8));
  EXPECT_TRUE(read_bytes(file).data.empty());
  EXPECT_FALSE(read_bytes(file).report.losses.empty());
}

TEST_F(RecordingFile, ABombIsNotUnpacked) {
  // 100 MB of zeros in some hundred bytes of a chunk that claims them honestly.
  const SampleMessage bomb{"/a", "std_msgs/String", 1, std::string(size_t{100} << 20, '\0')};
  for (const std::string& bytes :
       {test::ros1_bag({bomb}, {"bz2", 1}), test::mcap_file({bomb}, {"zstd", 1})}) {
    ASSERT_LT(bytes.size(), 100000u);
    const Contents contents = read_bytes(bytes);
    EXPECT_TRUE(contents.data.empty());
    EXPECT_FALSE(contents.report.losses.empty());
  }
}

TEST_F(RecordingFile, OtherFilesAreRefusedWithTheReason) {
  const auto reason = [&](std::string_view bytes) -> std::string {
    try {
      read_bytes(bytes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(reason("#ROSRECORD V1.2\n"), HasSubstr("another format (#ROSRECORD V1.2)"));
  EXPECT_THAT(reason("SQLite format 3\0 and nothing more"), HasSubstr("no ROS 1 bag"));
  EXPECT_THAT(reason(std::string("SQLite format 3\0 and nothing more", 33)), HasSubstr("damaged"));
  EXPECT_THAT(reason("x"), HasSubstr("no ROS 1 bag"));
}

TEST(Decompress, GivesUpAtTheClaimedSize) {
  const std::string bytes(1000, 'x');
  EXPECT_EQ(decompress(Codec::none, bytes, 1000).damage, "");
  EXPECT_EQ(decompress(Codec::none, bytes, 1000).bytes, bytes);
  EXPECT_THAT(decompress(Codec::none, bytes, 999).damage, HasSubstr("another size"));
  EXPECT_THAT(decompress(Codec::none, bytes, 1001).damage, HasSubstr("another size"));
  EXPECT_THAT(decompress(Codec::none, bytes, uint64_t{1} << 40).damage, HasSubstr("too much"));
  for (const Codec codec : {Codec::bz2, Codec::lz4, Codec::zstd})
    EXPECT_NE(decompress(codec, bytes, 5).damage, "");
}

}  // namespace
}  // namespace hmt::submap
