// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "line_source.hpp"

#include <algorithm>
#include <cstring>

#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

constexpr size_t kChunkBytes = 1 << 16;

}  // namespace

LineSource::LineSource(const std::filesystem::path& path)
    : path_(path), bytes_(open_bytes(path)), buffer_(2 * kChunkBytes) {}

std::string LineSource::place() const {
  return path_.string() + ":" + std::to_string(line_number_);
}

bool LineSource::fill() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ > kMaxLineBytes)
    throw graph::InputError(path_.string() + ":" + std::to_string(line_number_ + 1) +
                            ": the line is longer than " + std::to_string(kMaxLineBytes) +
                            " bytes; this is no text log");
  if (buffer_.size() < end_ + kChunkBytes) buffer_.resize(2 * buffer_.size());
  const size_t count = bytes_->read(buffer_.data() + end_, kChunkBytes);
  end_ += count;
  return count > 0;
}

std::optional<std::string_view> LineSource::next() {
  size_t searched = begin_;
  while (true) {
    const char* from = buffer_.data() + searched;
    const void* hit = std::memchr(from, '\n', end_ - searched);
    if (hit != nullptr || (searched = end_ - begin_, !fill())) {
      const auto* stop = hit ? static_cast<const char*>(hit) : buffer_.data() + end_;
      const char* start = buffer_.data() + begin_;
      if (!hit && start == stop) return std::nullopt;
      ++line_number_;
      complete_ = hit != nullptr;
      std::string_view line(start, static_cast<size_t>(stop - start));
      begin_ += line.size() + (hit ? 1 : 0);
      if (line.ends_with('\r')) line.remove_suffix(1);
      return line;
    }
  }
}

}  // namespace hmt::submap
