// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/zstd.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <fstream>
#include <sstream>

#include "hmt/graph/input_error.hpp"
#include "log/line_source.hpp"
#include "temporary_folder.hpp"

namespace hmt::submap {
namespace {

namespace io = boost::iostreams;

/// Lines that do not compress to nothing.
std::string some_text() {
  std::string text;
  uint32_t state = 1;
  for (int i = 0; i < 200000; ++i) {
    state = state * 1664525u + 1013904223u;
    text += std::to_string(state) + (i % 10 == 9 ? "\n" : " ");
  }
  return text;
}

template <typename Compressor>
std::string compressed(const std::string& text) {
  std::istringstream in(text);
  std::ostringstream out;
  io::filtering_ostream stream;
  stream.push(Compressor());
  stream.push(out);
  io::copy(in, stream);
  stream.reset();
  return out.str();
}

struct Decoded {
  std::string text;
  std::string damage;
};

Decoded decode(const std::string& bytes) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "a", std::ios::binary) << bytes;
  const auto source = open_bytes(folder.path() / "a");
  Decoded decoded;
  std::string chunk(10000, '\0');
  while (const size_t count = source->read(chunk.data(), chunk.size()))
    decoded.text.append(chunk, 0, count);
  decoded.damage = source->damage();
  return decoded;
}

template <typename Compressor>
class CompressedBytes : public testing::Test {};
using Compressors = testing::Types<io::gzip_compressor, io::bzip2_compressor, io::zstd_compressor>;
TYPED_TEST_SUITE(CompressedBytes, Compressors);

TYPED_TEST(CompressedBytes, AreDecodedWhole) {
  const std::string text = some_text();
  const Decoded decoded = decode(compressed<TypeParam>(text));
  EXPECT_EQ(decoded.text, text);
  EXPECT_EQ(decoded.damage, "");
}

TYPED_TEST(CompressedBytes, MayConsistOfSeveralStreams) {
  const std::string one = compressed<TypeParam>("one\n");
  const Decoded decoded = decode(one + compressed<TypeParam>("two\n"));
  EXPECT_EQ(decoded.text, "one\ntwo\n");
  EXPECT_EQ(decoded.damage, "");
}

TYPED_TEST(CompressedBytes, GiveAllBeforeACut) {
  const std::string text = some_text();
  const std::string bytes = compressed<TypeParam>(text);
  const Decoded decoded = decode(bytes.substr(0, bytes.size() * 3 / 4));
  EXPECT_GT(decoded.text.size(), text.size() / 3);
  EXPECT_EQ(decoded.text, text.substr(0, decoded.text.size()));
  EXPECT_THAT(decoded.damage, testing::HasSubstr(std::to_string(bytes.size() * 3 / 4)));
}

TYPED_TEST(CompressedBytes, GiveAllBeforeDamage) {
  const std::string text = some_text();
  std::string bytes = compressed<TypeParam>(text);
  for (size_t i = bytes.size() * 3 / 4; i < bytes.size() * 3 / 4 + 1000; ++i) bytes[i] = '\x55';
  const Decoded decoded = decode(bytes);
  EXPECT_GT(decoded.text.size(), text.size() / 3);
  EXPECT_NE(decoded.damage, "");
}

TEST(LineSource, CountsLinesOfEveryKind) {
  const test::TemporaryFolder folder;
  std::ofstream(folder.path() / "a", std::ios::binary) << "one\r\n\nthree";
  LineSource lines(folder.path() / "a");
  EXPECT_EQ(lines.next(), "one");
  EXPECT_EQ(lines.next(), "");
  EXPECT_TRUE(lines.line_is_complete());
  EXPECT_EQ(lines.next(), "three");
  EXPECT_FALSE(lines.line_is_complete());
  EXPECT_EQ(lines.line_number(), 3);
  EXPECT_EQ(lines.next(), std::nullopt);
}

TEST(LineSource, TakesLongLinesUpToItsLimit) {
  const test::TemporaryFolder folder;
  const std::string longest(LineSource::kMaxLineBytes - 10, 'a');
  std::ofstream(folder.path() / "a") << longest << "\nb\n" << longest << longest << "\n";
  LineSource lines(folder.path() / "a");
  EXPECT_EQ(lines.next(), longest);
  EXPECT_EQ(lines.next(), "b");
  EXPECT_THROW(lines.next(), graph::InputError);
}

}  // namespace
}  // namespace hmt::submap
