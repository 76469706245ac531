// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace hmt::submap {

/// How the members of a message follow each other. CDR aligns numbers to their size, ends strings
/// with a zero byte, and starts with four bytes that tell the byte order; ROS 1 does none of it.
enum class Wire { ros1, cdr };

/// A message that ends too early, or holds a number that cannot be.
class MessageError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// The number at `bytes`, in whichever byte order.
template <typename Number>
Number load_number(const char* bytes, bool little_endian) {
  char raw[sizeof(Number)];
  if (little_endian == (std::endian::native == std::endian::little)) {
    std::memcpy(raw, bytes, sizeof raw);
  } else {
    for (size_t i = 0; i < sizeof raw; ++i) raw[i] = bytes[sizeof raw - 1 - i];
  }
  Number value;
  std::memcpy(&value, raw, sizeof raw);
  return value;
}

/// Takes one member after the other off a serialized message. Every read throws MessageError
/// instead of leaving the message.
class WireReader {
 public:
  WireReader(std::string_view message, Wire wire);

  template <typename Number>
  Number number() {
    align(sizeof(Number));
    return load_number<Number>(take(sizeof(Number)).data(), little_endian_);
  }
  std::string_view text();
  /// The length of a sequence whose elements take at least so many bytes each.
  size_t count(size_t least_bytes);
  /// So many bytes as they are.
  std::string_view take(size_t size);
  /// All that is left.
  std::string_view rest() { return take(message_.size() - position_); }
  /// Passes over so many numbers.
  template <typename Number>
  void skip(size_t numbers) {
    if (numbers == 0) return;
    align(sizeof(Number));
    take(numbers * sizeof(Number));
  }
  bool is_cdr() const { return wire_ == Wire::cdr; }

 private:
  void align(size_t size);

  std::string_view message_;
  size_t position_ = 0;
  Wire wire_;
  bool little_endian_ = true;
  size_t greatest_alignment_ = 8;
};

}  // namespace hmt::submap
