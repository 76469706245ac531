// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "byte_reader.hpp"
#include "topic_table.hpp"

namespace hmt::submap {

/// Reads a ROS 1 bag, format 2.0 (wiki.ros.org/Bags/Format/2.0), chunk after chunk, compressed by
/// bz2, lz4 or not. The index is never looked at, so bags that were not closed are read as well;
/// a damaged chunk costs what comes after the damage in that chunk.
class Ros1Bag : public Recording {
 public:
  explicit Ros1Bag(const std::filesystem::path& path);

  std::optional<RecordedMessage> next() override;
  const std::vector<RecordedTopic>& topics() const override { return topics_.topics(); }
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return file_.bytes_read(); }

  /// Whether a file that begins so is a ROS 1 bag of any format.
  static bool begins_with(std::string_view head);

 private:
  struct Record;
  std::optional<RecordedMessage> next_in_chunk();
  std::optional<RecordedMessage> next_in_file();
  bool read_record();
  std::optional<RecordedMessage> use_record(const Record& record);
  std::optional<RecordedMessage> message(const Record& record) const;
  void check_header(const Record& record) const;
  void open_chunk(const Record& record);
  void add_connection(const Record& record);
  void lose_rest();

  ByteReader file_;
  LogReport report_;
  TopicTable topics_;
  std::map<uint32_t, size_t> topic_of_connection_;
  std::string header_;  ///< of the present record of the file
  std::string data_;    ///< its data
  std::string chunk_;   ///< the present chunk, decoded
  std::string_view rest_of_chunk_;
  std::string chunk_place_;
  bool record_is_cut_ = false;  ///< the file ends inside it
  bool at_end_ = false;
};

}  // namespace hmt::submap
