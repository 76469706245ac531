// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <memory>

#include "topic_table.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace hmt::submap {

/// Reads a ROS 2 bag in SQLite (rosbag2_storage_sqlite3): tables `topics` and `messages`, in the
/// order in which the messages were recorded.
class SqliteBag : public Recording {
 public:
  explicit SqliteBag(const std::filesystem::path& path);

  std::optional<RecordedMessage> next() override;
  const std::vector<RecordedTopic>& topics() const override { return topics_.topics(); }
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return bytes_read_; }

  static bool begins_with(std::string_view head);

 private:
  using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
  using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

  Database open() const;
  void check_tables() const;
  Statement prepare(const char* sql) const;
  void read_topics();
  std::string place() const;
  [[noreturn]] void refuse(const std::string& reason) const;

  std::filesystem::path path_;
  Database database_;
  Statement messages_;
  LogReport report_;
  TopicTable topics_;
  std::map<int64_t, size_t> topic_of_id_;
  std::string unpacked_;  ///< the present message, if it was compressed
  int64_t rows_ = 0;
  int64_t bytes_read_ = 0;
};

}  // namespace hmt::submap
