// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sqlite_bag.hpp"

#include <sqlite3.h>
#include <zstd.h>

#include "../report_book.hpp"
#include "decompress.hpp"

namespace hmt::submap {
namespace {

constexpr std::string_view kMagic{"SQLite format 3\0", 16};
constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";
constexpr int kMaxMessageBytes = 256 << 20;

std::string text(sqlite3_stmt* row, int column) {
  const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return bytes == nullptr ? "" : bytes;
}

std::string_view blob(sqlite3_stmt* row, int column) {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(row, column));
  return {bytes, bytes == nullptr ? 0 : static_cast<size_t>(sqlite3_column_bytes(row, column))};
}

/// rosbag2 can compress each message on its own; a message of CDR never begins like this.
Decoded unpack(std::string_view message) {
  const auto size = ZSTD_getFrameContentSize(message.data(), message.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR)
    return {"", "compressed data of unknown size"};
  return decompress(Codec::zstd, message, size);
}

}  // namespace

bool SqliteBag::begins_with(std::string_view head) {
  return head.starts_with(kMagic);
}

SqliteBag::SqliteBag(const std::filesystem::path& path)
    : path_(path), database_(open()), messages_(nullptr, &sqlite3_finalize) {
  check_tables();
  read_topics();
  // By rowid, not by time: one pass over the file, which needs no memory to sort.
  messages_ = prepare("SELECT topic_id, timestamp, data FROM messages ORDER BY rowid");
}

SqliteBag::Database SqliteBag::open() const {
  // A log in a read-only folder can be opened only if nobody writes to it, and then as immutable.
  for (const char* mode : {"mode=ro", "immutable=1"}) {
    std::string uri = "file:";
    for (const char c : std::filesystem::absolute(path_).string()) {
      if (c == '?' || c == '#' || c == '%') {
        constexpr char kHex[] = "0123456789ABCDEF";
        uri.append({'%', kHex[c >> 4], kHex[c & 15]});
      } else {
        uri += c;
      }
    }
    sqlite3* handle = nullptr;
    const int result = sqlite3_open_v2(uri.append("?").append(mode).c_str(), &handle,
                                       SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    Database database(handle, &sqlite3_close);
    if (result != SQLITE_OK) continue;
    sqlite3_limit(handle, SQLITE_LIMIT_LENGTH, kMaxMessageBytes);
    sqlite3_db_config(handle, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    // Otherwise SQLite refuses a file that is shorter than its header tells, whole as it may be up
    // to there. Nothing can be written all the same.
    sqlite3_db_config(handle, SQLITE_DBCONFIG_WRITABLE_SCHEMA, 1, nullptr);
    if (sqlite3_exec(handle, "SELECT count(*) FROM sqlite_schema", nullptr, nullptr, nullptr) ==
        SQLITE_OK)
      return database;
  }
  refuse("cannot be read as an SQLite database; it is damaged or cut");
}

void SqliteBag::check_tables() const {
  // A plain table has pages of its own; a view or a virtual table could compute without end.
  const Statement tables = prepare(
      "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND rootpage > 0 "
      "AND name IN ('topics', 'messages') AND sql NOT LIKE '%generated%' AND sql NOT LIKE '% as "
      "%'");
  if (sqlite3_step(tables.get()) != SQLITE_ROW || sqlite3_column_int(tables.get(), 0) != 2)
    refuse(
        "an SQLite database, but neither a map nor a ROS 2 bag, whose tables are topics and "
        "messages");
}

SqliteBag::Statement SqliteBag::prepare(const char* sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK)
    refuse(std::string("no ROS 2 bag: ") + sqlite3_errmsg(database_.get()));
  return {statement, &sqlite3_finalize};
}

void SqliteBag::read_topics() {
  const Statement rows =
      prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    RecordedTopic topic{text(rows.get(), 1), text(rows.get(), 2), std::nullopt};
    if (text(rows.get(), 3) == "cdr") topic.wire = Wire::cdr;
    topic_of_id_[sqlite3_column_int64(rows.get(), 0)] = topics_.add(topic);
  }
  if (result != SQLITE_DONE) refuse("the table of topics is damaged");
}

std::optional<RecordedMessage> SqliteBag::next() {
  while (messages_) {
    const int result = sqlite3_step(messages_.get());
    if (result != SQLITE_ROW) {
      if (result != SQLITE_DONE)
        add_loss(report_, "the database is damaged, the rest is left out", place());
      messages_.reset();
      break;
    }
    ++rows_;
    sqlite3_stmt* row = messages_.get();
    RecordedMessage message;
    const auto topic = topic_of_id_.find(sqlite3_column_int64(row, 0));
    message.received_ns = sqlite3_column_int64(row, 1);
    message.data = blob(row, 2);
    bytes_read_ += static_cast<int64_t>(message.data.size());
    if (topic == topic_of_id_.end()) {
      add_loss(report_, "messages of an unknown topic", place());
      continue;
    }
    message.topic = topic->second;
    if (message.data.starts_with(kZstdMagic)) {
      Decoded decoded = unpack(message.data);
      if (!decoded.damage.empty()) {
        add_loss(report_, "damaged messages: " + decoded.damage, place());
        continue;
      }
      unpacked_ = std::move(decoded.bytes);
      message.data = unpacked_;
    }
    return message;
  }
  return std::nullopt;
}

std::string SqliteBag::place() const {
  return path_.string() + ": message " + std::to_string(rows_);
}

void SqliteBag::refuse(const std::string& reason) const {
  throw InputError(path_.string() + ": " + reason);
}

}  // namespace hmt::submap
