// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "byte_reader.hpp"

#include <algorithm>
#include <cstring>

#include "decompress.hpp"

namespace hmt::submap {
namespace {

constexpr size_t kBufferBytes = size_t{64} << 10;

}  // namespace

bool ByteReader::refill() {
  buffer_.resize(kBufferBytes);
  buffer_.resize(source_->read(buffer_.data(), kBufferBytes));
  begin_ = 0;
  return !buffer_.empty();
}

size_t ByteReader::take(char* out, size_t size) {
  if (begin_ == buffer_.size() && !refill()) return 0;
  const size_t count = std::min(size, buffer_.size() - begin_);
  if (out != nullptr) std::memcpy(out, buffer_.data() + begin_, count);
  begin_ += count;
  position_ += static_cast<int64_t>(count);
  return count;
}

bool ByteReader::read(uint64_t size, std::string& out) {
  out.clear();
  while (out.size() < size) {
    // The file may be compressed, and then a bomb.
    if (out.size() >= most_decoded_bytes(static_cast<uint64_t>(bytes_read()))) return false;
    const size_t before = out.size();
    const size_t step = std::min<uint64_t>(size - before, std::max(kBufferBytes, before));
    out.resize(before + step);
    size_t filled = before;
    while (filled < out.size()) {
      const size_t count = take(out.data() + filled, out.size() - filled);
      if (count == 0) break;
      filled += count;
    }
    const bool ended = filled < out.size();
    out.resize(filled);
    if (ended) return false;
  }
  return true;
}

bool ByteReader::skip(uint64_t size) {
  while (size > 0) {
    const size_t count = take(nullptr, std::min<uint64_t>(size, kBufferBytes));
    if (count == 0) return false;
    size -= count;
  }
  return true;
}

std::string ByteReader::place() const {
  return path_.string() + ": byte " + std::to_string(position_);
}

}  // namespace hmt::submap
