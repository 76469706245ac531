// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/export/atomic_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "hmt/graph/input_error.hpp"

namespace hmt::submap {

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(path_.string() + ".tmp"), file_(nullptr, &std::fclose) {
  if (std::filesystem::is_directory(path_))
    throw graph::InputError(path_.string() + ": is a folder, name a file");
  file_.reset(std::fopen(temporary_.c_str(), "wb"));
  if (!file_) fail("cannot be written");
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;  // nothing more can be done about a leftover
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    fail("writing failed");
}

void AtomicFile::commit() {
  if (std::fflush(file_.get()) != 0 || fsync(fileno(file_.get())) != 0) fail("writing failed");
  file_.reset();
  std::error_code error;
  std::filesystem::rename(temporary_, path_, error);
  if (error) throw graph::InputError(path_.string() + ": cannot be replaced: " + error.message());
}

void AtomicFile::fail(const char* what) const {
  throw graph::InputError(path_.string() + ": " + what + ": " + std::strerror(errno));
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace hmt::submap
