// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hmt::graph {

/// The lines of a text file, plain or gzip, one after the other, in bounded memory.
class GzipLines {
 public:
  /// Throws InputError for a missing or unreadable file and a folder.
  explicit GzipLines(const std::filesystem::path& path);

  /// The next line without its end (\n or \r\n), valid until the next call; nothing at the end.
  /// Throws InputError for damaged or truncated gzip data and for a line above 64 kB.
  std::optional<std::string_view> next();
  int64_t line_number() const { return line_number_; }

  /// Throws InputError: "FILE:LINE: reason", with the line that next() returned last.
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  // Moves what is left to the front and reads on; false at the end of the file.
  bool fill();

  std::string name_;
  std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> file_;
  std::vector<char> buffer_;
  size_t begin_ = 0;
  size_t end_ = 0;
  int64_t line_number_ = 0;
};

}  // namespace hmt::graph
