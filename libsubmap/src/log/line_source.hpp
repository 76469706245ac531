// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hmt::submap {

/// Delivers the decoded bytes of one file, plain or compressed.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Fills `out` from the front; fewer bytes than asked only at the end. Never throws for damaged
  /// data: what was decoded before the damage is returned and damage() tells the rest.
  virtual size_t read(char* out, size_t size) = 0;
  /// Why the data ended early; empty where it did not.
  virtual const std::string& damage() const = 0;
  /// Bytes taken from the file itself.
  virtual int64_t bytes_read() const = 0;
};

/// Opens a file; gz, bz2 and zst are told by their first bytes, not by name. Throws InputError for
/// a missing or unreadable file, a folder and an empty file.
std::unique_ptr<ByteSource> open_bytes(const std::filesystem::path& path);

/// The first decoded bytes of a file, up to some kilobytes. Throws as open_bytes does.
std::string first_bytes(const std::filesystem::path& path);

/// The lines of a file, one after the other, in bounded memory.
class LineSource {
 public:
  /// A laser scan takes some kilobytes; a longer line than this is not a log.
  static constexpr size_t kMaxLineBytes = size_t{4} << 20;

  explicit LineSource(const std::filesystem::path& path);

  /// The next line without its end (\n or \r\n), valid until the next call; nothing at the end.
  /// Throws InputError naming file and line for a line longer than kMaxLineBytes.
  std::optional<std::string_view> next();
  /// Number of the line that next() returned last, from 1.
  int64_t line_number() const { return line_number_; }
  /// "file:line" of the line that next() returned last.
  std::string place() const;
  /// False for a last line without its line end.
  bool line_is_complete() const { return complete_; }
  const std::string& damage() const { return bytes_->damage(); }
  int64_t bytes_read() const { return bytes_->bytes_read(); }
  const std::filesystem::path& path() const { return path_; }

 private:
  bool fill();

  std::filesystem::path path_;
  std::unique_ptr<ByteSource> bytes_;
  std::vector<char> buffer_;
  size_t begin_ = 0;
  size_t end_ = 0;
  int64_t line_number_ = 0;
  bool complete_ = true;
};

}  // namespace hmt::submap
