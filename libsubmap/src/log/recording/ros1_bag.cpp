// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ros1_bag.hpp"

#include <algorithm>

#include "../report_book.hpp"
#include "decompress.hpp"

namespace hmt::submap {
namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
// Formats before 2.0, which nothing has written since 2010.
constexpr std::string_view kOldMagics[] = {"#ROSRECORD V", "#ROSLOG V", "#ROSBAG V"};
constexpr uint32_t kMaxHeaderBytes = 1 << 20;
constexpr int64_t kNanosecondsPerSecond = 1'000'000'000;

enum Op : unsigned char {
  kUnknown = 0x00,
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07
};

uint32_t to_u32(std::string_view bytes) {
  if (bytes.size() < sizeof(uint32_t)) throw MessageError("a number is cut");
  return load_number<uint32_t>(bytes.data(), true);
}

/// Splits so many bytes off the front, told by the four bytes before them.
std::string_view take_block(std::string_view& bytes) {
  const uint32_t size = to_u32(bytes);
  bytes.remove_prefix(sizeof size);
  if (size > bytes.size()) throw MessageError("a record reaches beyond the end");
  const std::string_view block = bytes.substr(0, size);
  bytes.remove_prefix(size);
  return block;
}

/// The value of a field of a header, which is a row of "name=value"; throws MessageError if it is
/// not there.
std::string_view field(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::string_view entry = take_block(header);
    if (entry.size() > name.size() && entry.starts_with(name) && entry[name.size()] == '=')
      return entry.substr(name.size() + 1);
  }
  throw MessageError("a record has no field " + std::string(name));
}

bool has_field(std::string_view header, std::string_view name) {
  try {
    return !field(header, name).empty();
  } catch (const MessageError&) {
    return false;
  }
}

Codec codec_of(std::string_view name) {
  if (name == "none") return Codec::none;
  if (name == "bz2") return Codec::bz2;
  if (name == "lz4") return Codec::lz4;
  throw MessageError("chunk of unknown compression");
}

}  // namespace

struct Ros1Bag::Record {
  std::string_view header;
  std::string_view data;

  Op find_op() const {
    try {
      const std::string_view value = field(header, "op");
      return value.empty() ? kUnknown : static_cast<Op>(value[0]);
    } catch (const MessageError&) {
      return kUnknown;
    }
  }
};

bool Ros1Bag::begins_with(std::string_view head) {
  return std::ranges::any_of(kOldMagics, [&](auto magic) { return head.starts_with(magic); });
}

Ros1Bag::Ros1Bag(const std::filesystem::path& path) : file_(path) {
  const std::string head = first_bytes(path);
  if (!head.starts_with(kMagic))
    throw InputError(path.string() + ": a ROS bag of another format (" +
                     head.substr(0, std::min<size_t>(head.find('\n'), 40)) +
                     ") than 2.0; convert it by `rosbag fix` of ROS 1");
  file_.skip(kMagic.size());
}

std::optional<RecordedMessage> Ros1Bag::next() {
  while (true) {
    if (auto message = next_in_chunk()) return message;
    if (at_end_) return std::nullopt;
    if (auto message = next_in_file()) return message;
  }
}

std::optional<RecordedMessage> Ros1Bag::next_in_chunk() {
  while (!rest_of_chunk_.empty()) {
    try {
      const std::string_view header = take_block(rest_of_chunk_);
      const Record record{header, take_block(rest_of_chunk_)};
      const Op op = record.find_op();
      if (op == kMessage) return message(record);
      if (op != kConnection) throw MessageError("a record of unknown kind");
      add_connection(record);
    } catch (const MessageError& error) {
      add_loss(report_, std::string("damaged chunks, cut there: ") + error.what(), chunk_place_);
      rest_of_chunk_ = {};
    }
  }
  return std::nullopt;
}

std::optional<RecordedMessage> Ros1Bag::next_in_file() {
  const std::string place = file_.place();
  if (!read_record()) {
    at_end_ = true;
    return std::nullopt;
  }
  try {
    return use_record({header_, data_});
  } catch (const MessageError& error) {
    add_loss(report_, std::string("damaged records: ") + error.what(), place);
  }
  return std::nullopt;
}

bool Ros1Bag::read_record() {
  std::string size;
  if (!file_.read(sizeof(uint32_t), size)) {
    // A file that ends between two records is whole.
    if (!size.empty() || !file_.damage().empty()) lose_rest();
    return false;
  }
  if (to_u32(size) > kMaxHeaderBytes || !file_.read(to_u32(size), header_) ||
      !file_.read(sizeof(uint32_t), size)) {
    lose_rest();
    return false;
  }
  const uint64_t data_bytes = to_u32(size);
  const Op op = Record{header_, {}}.find_op();
  data_.clear();
  const bool is_used = op == kMessage || op == kChunk || op == kConnection;
  record_is_cut_ = !(is_used ? file_.read(data_bytes, data_) : file_.skip(data_bytes));
  if (record_is_cut_) lose_rest();
  // Of a chunk that was cut the first messages are still good.
  return !record_is_cut_ || op == kChunk;
}

std::optional<RecordedMessage> Ros1Bag::use_record(const Record& record) {
  const Op op = record.find_op();
  if (op == kMessage) return message(record);
  if (op == kBagHeader) check_header(record);
  if (op == kConnection) add_connection(record);
  if (op == kChunk) open_chunk(record);
  if (op == kUnknown) throw MessageError("a record of unknown kind");
  return std::nullopt;
}

std::optional<RecordedMessage> Ros1Bag::message(const Record& record) const {
  const auto topic = topic_of_connection_.find(to_u32(field(record.header, "conn")));
  if (topic == topic_of_connection_.end()) throw MessageError("a message of an unknown topic");
  const std::string_view time = field(record.header, "time");
  const int64_t seconds = to_u32(time);
  const int64_t nanoseconds = to_u32(time.substr(sizeof(uint32_t)));
  return RecordedMessage{topic->second, seconds * kNanosecondsPerSecond + nanoseconds, record.data};
}

void Ros1Bag::check_header(const Record& record) const {
  if (has_field(record.header, "encryptor"))
    throw InputError(file_.path().string() + ": the bag is encrypted; decrypt it by rosbag");
}

void Ros1Bag::open_chunk(const Record& record) {
  const Codec codec = codec_of(field(record.header, "compression"));
  Decoded decoded = decompress(codec, record.data, to_u32(field(record.header, "size")));
  chunk_place_ = file_.place();
  chunk_ = std::move(decoded.bytes);
  rest_of_chunk_ = chunk_;
  if (!decoded.damage.empty() && !record_is_cut_)
    add_loss(report_, "damaged chunks: " + decoded.damage, chunk_place_);
}

void Ros1Bag::add_connection(const Record& record) {
  const uint32_t connection = to_u32(field(record.header, "conn"));
  RecordedTopic topic;
  topic.name = field(record.header, "topic");
  topic.type = field(record.data, "type");
  topic.wire = Wire::ros1;
  topic_of_connection_[connection] = topics_.add(topic);
}

void Ros1Bag::lose_rest() {
  const std::string& damage = file_.damage();
  add_loss(report_, damage.empty() ? "the bag is cut or damaged, the rest is left out" : damage,
           file_.place());
}

}  // namespace hmt::submap
