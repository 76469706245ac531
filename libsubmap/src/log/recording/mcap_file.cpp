// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "mcap_file.hpp"

#include <zlib.h>

#include <algorithm>

#include "../report_book.hpp"
#include "decompress.hpp"

namespace hmt::submap {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
constexpr size_t kRecordHeaderBytes = 1 + 8;

enum Op {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kDataEnd = 0x0F
};

/// Whether a record holds what is used here; all others are passed over.
bool is_used(int op) {
  return op == kSchema || op == kChannel || op == kMessage || op == kChunk;
}

Codec codec_of(std::string_view name) {
  if (name.empty()) return Codec::none;
  if (name == "lz4") return Codec::lz4;
  if (name == "zstd") return Codec::zstd;
  throw MessageError("chunk of unknown compression");
}

uint32_t checksum(std::string_view bytes) {
  return static_cast<uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::optional<Wire> wire_of(std::string_view message_encoding) {
  if (message_encoding == "cdr") return Wire::cdr;
  if (message_encoding == "ros1") return Wire::ros1;
  return std::nullopt;
}

/// MCAP's own records are little endian and packed, as the messages of ROS 1 are.
WireReader reader_of(std::string_view content) {
  return {content, Wire::ros1};
}

}  // namespace

bool McapFile::begins_with(std::string_view head) {
  return head.starts_with(kMagic);
}

McapFile::McapFile(const std::filesystem::path& path) : file_(path) {
  file_.skip(kMagic.size());
}

std::optional<RecordedMessage> McapFile::next() {
  while (true) {
    if (auto message = next_in_chunk()) return message;
    if (at_end_) return std::nullopt;
    if (auto message = next_in_file()) return message;
  }
}

std::optional<RecordedMessage> McapFile::next_in_chunk() {
  while (!rest_of_chunk_.empty()) {
    try {
      WireReader header = reader_of(rest_of_chunk_);
      const int op = header.number<uint8_t>();
      const std::string_view content = header.take(header.number<uint64_t>());
      rest_of_chunk_.remove_prefix(kRecordHeaderBytes + content.size());
      if (auto message = use_record(op, content)) return message;
    } catch (const MessageError& error) {
      add_loss(report_, std::string("damaged chunks, cut there: ") + error.what(), chunk_place_);
      rest_of_chunk_ = {};
    }
  }
  return std::nullopt;
}

std::optional<RecordedMessage> McapFile::next_in_file() {
  const std::string place = file_.place();
  std::string header;
  if (!file_.read(kRecordHeaderBytes, header)) {
    at_end_ = true;
    if (!header.empty() || !file_.damage().empty())
      lose_rest();
    else
      add_note(report_, "the recording was not closed: no footer", place);
    return std::nullopt;
  }
  const int op = static_cast<unsigned char>(header[0]);
  const auto size = load_number<uint64_t>(header.data() + 1, true);
  if (op == kFooter || op == kDataEnd) {
    at_end_ = true;
    return std::nullopt;
  }
  content_.clear();
  content_is_cut_ = !(is_used(op) ? file_.read(size, content_) : file_.skip(size));
  if (content_is_cut_) {
    at_end_ = true;
    lose_rest();
    // Of a chunk that was cut the first messages are still good.
    if (op != kChunk) return std::nullopt;
  }
  try {
    if (op == kChunk) open_chunk(content_);
    return use_record(op, content_);
  } catch (const MessageError& error) {
    add_loss(report_, std::string("damaged records: ") + error.what(), place);
  }
  return std::nullopt;
}

std::optional<RecordedMessage> McapFile::use_record(int op, std::string_view content) {
  if (op == kSchema) add_schema(content);
  if (op == kChannel) add_channel(content);
  if (op == kMessage) return message(content);
  return std::nullopt;
}

void McapFile::add_schema(std::string_view content) {
  WireReader in = reader_of(content);
  const auto id = in.number<uint16_t>();
  type_of_schema_[id] = in.text();
}

void McapFile::add_channel(std::string_view content) {
  WireReader in = reader_of(content);
  const auto id = in.number<uint16_t>();
  const auto schema = in.number<uint16_t>();
  RecordedTopic topic;
  topic.name = in.text();
  topic.wire = wire_of(in.text());
  const auto type = type_of_schema_.find(schema);
  if (type != type_of_schema_.end()) topic.type = type->second;
  topic_of_channel_[id] = topics_.add(topic);
}

std::optional<RecordedMessage> McapFile::message(std::string_view content) const {
  constexpr size_t kMessageHeaderBytes = 2 + 4 + 8 + 8;
  WireReader in = reader_of(content);
  const auto topic = topic_of_channel_.find(in.number<uint16_t>());
  in.skip<uint32_t>(1);  // sequence number
  const auto log_time = in.number<uint64_t>();
  in.skip<uint64_t>(1);  // publish time
  if (topic == topic_of_channel_.end()) throw MessageError("a message of an unknown channel");
  return RecordedMessage{topic->second, static_cast<int64_t>(log_time),
                         content.substr(kMessageHeaderBytes)};
}

void McapFile::open_chunk(std::string_view content) {
  WireReader in = reader_of(content);
  in.skip<uint64_t>(2);  // first and last time
  const auto size = in.number<uint64_t>();
  const auto crc = in.number<uint32_t>();
  const Codec codec = codec_of(in.text());
  const auto encoded_size = in.number<uint64_t>();
  const std::string_view encoded = content_is_cut_ ? in.rest() : in.take(encoded_size);
  Decoded decoded = decompress(codec, encoded, size);
  if (!content_is_cut_) {
    if (!decoded.damage.empty()) {
      add_loss(report_, "damaged chunks: " + decoded.damage, file_.place());
    } else if (crc != 0 && crc != checksum(decoded.bytes)) {
      throw MessageError("a chunk with a wrong checksum");
    }
  }
  chunk_place_ = file_.place();
  chunk_ = std::move(decoded.bytes);
  rest_of_chunk_ = chunk_;
}

void McapFile::lose_rest() {
  const std::string& damage = file_.damage();
  add_loss(report_,
           damage.empty() ? "the recording is cut or damaged, the rest is left out" : damage,
           file_.place());
}

}  // namespace hmt::submap
