// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "recording_writers.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <fstream>
#include <stdexcept>

namespace hmt::test {
namespace {

using submap::Wire;

std::string compress(const std::string& codec, const std::string& bytes) {
  std::string out(2 * bytes.size() + 4096, '\0');
  if (codec == "none" || codec.empty()) return bytes;
  if (codec == "lz4") {
    out.resize(LZ4F_compressFrameBound(bytes.size(), nullptr));
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  } else if (codec == "zstd") {
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  } else if (codec == "bz2") {
    auto size = static_cast<unsigned>(out.size());
    BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()),
                             static_cast<unsigned>(bytes.size()), 9, 0, 0);
    out.resize(size);
  } else {
    throw std::invalid_argument(codec);
  }
  return out;
}

template <typename Number>
std::string le(Number value) {
  return WireWriter(Wire::ros1).number(value).bytes();
}

using Fields = std::vector<std::pair<std::string, std::string>>;

std::string bag_fields(const Fields& fields) {
  std::string bytes;
  for (const auto& [name, value] : fields)
    bytes += WireWriter(Wire::ros1).text(name + "=" + value).bytes();
  return bytes;
}

std::string bag_record(const Fields& header, const std::string& data) {
  return WireWriter(Wire::ros1).text(bag_fields(header)).text(data).bytes();
}

std::string bag_chunk(const std::string& records, const std::string& codec) {
  return bag_record(
      {{"compression", codec}, {"op", "\x05"}, {"size", le(static_cast<uint32_t>(records.size()))}},
      compress(codec, records));
}

std::string mcap_record(int op, const std::string& content) {
  return le(static_cast<uint8_t>(op)) + le(static_cast<uint64_t>(content.size())) + content;
}

std::string mcap_chunk(const std::string& records, const std::string& codec) {
  const std::string packed = compress(codec, records);
  const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(records.data()), records.size());
  return mcap_record(0x06, WireWriter(Wire::ros1)
                               .number(uint64_t{0})
                               .number(uint64_t{0})
                               .number(static_cast<uint64_t>(records.size()))
                               .number(static_cast<uint32_t>(crc))
                               .text(codec == "none" ? "" : codec)
                               .number(static_cast<uint64_t>(packed.size()))
                               .raw(packed)
                               .bytes());
}

std::string mcap_channel(uint16_t id, const SampleMessage& message) {
  WireWriter schema(Wire::ros1);
  schema.number(id).text(ros2_type(message.type)).text("ros2msg").text("");
  WireWriter channel(Wire::ros1);
  channel.number(id).number(id).text(message.topic).text("cdr").number(uint32_t{0});
  return mcap_record(0x03, schema.bytes()) + mcap_record(0x04, channel.bytes());
}

/// Gathers records into chunks.
template <typename MakeChunk>
class Chunks {
 public:
  Chunks(const ChunkOptions& options, MakeChunk make_chunk)
      : options_(options), make_chunk_(make_chunk) {}
  void add(const std::string& records) {
    (options_.messages == 0 ? file_ : chunk_) += records;
    if (++count_ % std::max<size_t>(1, options_.messages) == 0) close();
  }
  std::string finish() {
    close();
    return file_;
  }

 private:
  void close() {
    if (!chunk_.empty()) file_ += make_chunk_(chunk_, options_.codec);
    chunk_.clear();
  }
  ChunkOptions options_;
  MakeChunk make_chunk_;
  std::string chunk_;
  std::string file_;
  size_t count_ = 0;
};

void run_sql(sqlite3* database, const std::string& sql) {
  if (sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    throw std::runtime_error(sqlite3_errmsg(database));
}

}  // namespace

std::string ros1_bag(const std::vector<SampleMessage>& messages, const ChunkOptions& options) {
  Fields header = {{"chunk_count", le(uint32_t{0})},
                   {"conn_count", le(uint32_t{0})},
                   {"index_pos", le(uint64_t{0})},
                   {"op", "\x03"}};
  const std::string pad(4096 - 8 - bag_fields(header).size(), ' ');
  Chunks chunks(options, &bag_chunk);
  std::map<std::string, uint32_t> connections;
  for (const SampleMessage& m : messages) {
    const auto [place, is_new] =
        connections.try_emplace(m.topic, static_cast<uint32_t>(connections.size()));
    const std::string conn = le(place->second);
    std::string records;
    if (is_new)
      records = bag_record({{"conn", conn}, {"op", "\x07"}, {"topic", m.topic}},
                           bag_fields({{"md5sum", "*"}, {"topic", m.topic}, {"type", m.type}}));
    const std::string time = le(static_cast<uint32_t>(m.received_ns / 1'000'000'000)) +
                             le(static_cast<uint32_t>(m.received_ns % 1'000'000'000));
    records += bag_record({{"conn", conn}, {"op", "\x02"}, {"time", time}}, m.bytes);
    chunks.add(records);
  }
  return "#ROSBAG V2.0\n" + bag_record(header, pad) + chunks.finish();
}

std::string mcap_file(const std::vector<SampleMessage>& messages, const ChunkOptions& options,
                      bool footer) {
  const std::string magic = "\x89MCAP0\r\n";
  Chunks chunks(options, &mcap_chunk);
  std::map<std::string, uint16_t> channels;
  for (const SampleMessage& m : messages) {
    const auto [place, is_new] =
        channels.try_emplace(m.topic, static_cast<uint16_t>(channels.size() + 1));
    std::string records;
    if (is_new) records = mcap_channel(place->second, m);
    records += mcap_record(0x05, WireWriter(Wire::ros1)
                                     .number(place->second)
                                     .number(uint32_t{0})
                                     .number(static_cast<uint64_t>(m.received_ns))
                                     .number(static_cast<uint64_t>(m.received_ns))
                                     .raw(m.bytes)
                                     .bytes());
    chunks.add(records);
  }
  const std::string header = WireWriter(Wire::ros1).text("ros2").text("hmtmap tests").bytes();
  std::string file = magic + mcap_record(0x01, header) + chunks.finish();
  if (footer)
    file += mcap_record(0x0F, le(uint32_t{0})) +
            mcap_record(0x02, le(uint64_t{0}) + le(uint64_t{0}) + le(uint32_t{0})) + magic;
  return file;
}

void write_sqlite_bag(const std::filesystem::path& path,
                      const std::vector<SampleMessage>& messages) {
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> closer(database, &sqlite3_close);
  run_sql(database,
          "CREATE TABLE topics(id INTEGER PRIMARY KEY,name TEXT NOT NULL,type TEXT NOT NULL,"
          "serialization_format TEXT NOT NULL,offered_qos_profiles TEXT NOT NULL);"
          "CREATE TABLE messages(id INTEGER PRIMARY KEY,topic_id INTEGER NOT NULL,"
          "timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
          "CREATE INDEX timestamp_idx ON messages (timestamp ASC); BEGIN");
  std::map<std::string, int> topics;
  sqlite3_stmt* insert = nullptr;
  sqlite3_prepare_v2(database, "INSERT INTO messages VALUES(NULL, ?, ?, ?)", -1, &insert, nullptr);
  for (const SampleMessage& m : messages) {
    const auto [place, is_new] = topics.try_emplace(m.topic, static_cast<int>(topics.size()) + 1);
    if (is_new)
      run_sql(database, "INSERT INTO topics VALUES(" + std::to_string(place->second) + ",'" +
                            m.topic + "','" + ros2_type(m.type) + "','cdr','')");
    sqlite3_bind_int(insert, 1, place->second);
    sqlite3_bind_int64(insert, 2, m.received_ns);
    sqlite3_bind_blob(insert, 3, m.bytes.data(), static_cast<int>(m.bytes.size()),
                      SQLITE_TRANSIENT);
    sqlite3_step(insert);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  run_sql(database, "COMMIT");
}

std::string ros2_type(const std::string& type) {
  const size_t slash = type.find('/');
  return type.substr(0, slash) + "/msg" + type.substr(slash);
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace hmt::test
