// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace hmt::submap {

/// A file that appears whole or not at all: written as `PATH.tmp`, renamed to PATH by commit(). A
/// file that was there before is replaced at that moment; without commit() nothing changes. Not for
/// two writers of one path at a time.
class AtomicFile {
 public:
  /// Throws InputError where the folder is missing or not writable.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends. Throws InputError where the disk is full or fails.
  void write(std::string_view bytes);
  /// Flushes to the disk and renames. Throws InputError where that fails.
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

/// Writes a whole file, see AtomicFile.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace hmt::submap
