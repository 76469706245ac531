// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "../line_source.hpp"

namespace hmt::submap {

/// Reads blocks of told sizes from a file, plain or compressed, forward only. Memory follows what
/// is really there, not the told size.
class ByteReader {
 public:
  explicit ByteReader(const std::filesystem::path& path) : path_(path), source_(open_bytes(path)) {}

  /// Replaces `out` by the next `size` bytes; by those that are left if they are fewer, and then
  /// gives false.
  bool read(uint64_t size, std::string& out);
  /// Passes over `size` bytes; false if the file ends before.
  bool skip(uint64_t size);
  /// Decoded bytes taken so far.
  int64_t position() const { return position_; }
  /// "file: byte 123".
  std::string place() const;
  const std::string& damage() const { return source_->damage(); }
  int64_t bytes_read() const { return source_->bytes_read(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  size_t take(char* out, size_t size);
  bool refill();

  std::filesystem::path path_;
  std::unique_ptr<ByteSource> source_;
  std::string buffer_;
  size_t begin_ = 0;
  int64_t position_ = 0;
};

}  // namespace hmt::submap
