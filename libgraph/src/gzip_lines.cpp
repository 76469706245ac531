// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gzip_lines.hpp"

#include <cerrno>
#include <cstring>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

// Lines of numbers take some dozens of bytes; a longer line than this is not text.
constexpr size_t kMaxLineBytes = size_t{64} << 10;

}  // namespace

GzipLines::GzipLines(const std::filesystem::path& path)
    : name_(path.string()), file_(nullptr, gzclose_r), buffer_(4 * kMaxLineBytes) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    throw InputError(name_ + ": is a folder; a file is needed");
  errno = 0;
  file_.reset(gzopen(name_.c_str(), "rb"));
  if (!file_) throw InputError(name_ + ": cannot be opened: " + std::strerror(errno));
  gzbuffer(file_.get(), 1 << 17);
}

std::optional<std::string_view> GzipLines::next() {
  size_t searched = 0;
  for (;;) {
    const char* const start = buffer_.data() + begin_;
    const size_t left = end_ - begin_;
    const auto* const newline =
        static_cast<const char*>(std::memchr(start + searched, '\n', left - searched));
    const size_t length = newline != nullptr ? static_cast<size_t>(newline - start) : left;
    if (length > kMaxLineBytes) {
      ++line_number_;
      refuse("the line is longer than 64 kB; this is not a text file of numbers");
    }
    searched = left;
    if (newline == nullptr && fill()) continue;
    if (newline == nullptr && left == 0) return std::nullopt;
    ++line_number_;
    std::string_view line(buffer_.data() + begin_, length);
    begin_ += newline != nullptr ? length + 1 : length;
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
  }
}

void GzipLines::refuse(const std::string& reason) const {
  throw InputError(name_ + ":" + std::to_string(line_number_) + ": " + reason);
}

bool GzipLines::fill() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const int got =
      gzread(file_.get(), buffer_.data() + end_, static_cast<unsigned>(buffer_.size() - end_));
  int code = Z_OK;
  const char* const message = gzerror(file_.get(), &code);
  if (got < 0 || code == Z_BUF_ERROR)
    throw InputError(name_ + ": after line " + std::to_string(line_number_) +
                     ": the file is truncated or damaged (" + message + ")");
  end_ += static_cast<size_t>(got);
  return got > 0;
}

}  // namespace hmt::graph
