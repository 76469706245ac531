// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "byte_reader.hpp"
#include "topic_table.hpp"

namespace hmt::submap {

/// Reads an MCAP file (mcap.dev/spec) record after record, chunks compressed by lz4, zstd or not,
/// with their checksums. Footer and index are never looked at, so files that were not closed are
/// read as well; a chunk with a wrong checksum is left out.
class McapFile : public Recording {
 public:
  explicit McapFile(const std::filesystem::path& path);

  std::optional<RecordedMessage> next() override;
  const std::vector<RecordedTopic>& topics() const override { return topics_.topics(); }
  const LogReport& report() const override { return report_; }
  int64_t bytes_read() const override { return file_.bytes_read(); }

  static bool begins_with(std::string_view head);

 private:
  std::optional<RecordedMessage> next_in_chunk();
  std::optional<RecordedMessage> next_in_file();
  std::optional<RecordedMessage> use_record(int op, std::string_view content);
  void add_schema(std::string_view content);
  void add_channel(std::string_view content);
  std::optional<RecordedMessage> message(std::string_view content) const;
  void open_chunk(std::string_view content);
  void lose_rest();

  ByteReader file_;
  LogReport report_;
  TopicTable topics_;
  std::map<uint16_t, std::string> type_of_schema_;
  std::map<uint16_t, size_t> topic_of_channel_;
  std::string content_;  ///< of the present record of the file
  std::string chunk_;    ///< the present chunk, decoded
  std::string_view rest_of_chunk_;
  std::string chunk_place_;
  bool content_is_cut_ = false;  ///< the file ends inside it
  bool at_end_ = false;
};

}  // namespace hmt::submap
