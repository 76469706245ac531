// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "wire.hpp"

#include <algorithm>
#include <string>

namespace hmt::submap {
namespace {

constexpr size_t kCdrHeaderBytes = 4;
// Representation identifiers of plain CDR [DDS-XTypes 1.3, 7.6.3.1.2]; in version 2 numbers of
// eight bytes are aligned to four. The last bit tells little endian.
constexpr int kCdr = 0x00;
constexpr int kCdr2 = 0x06;

}  // namespace

WireReader::WireReader(std::string_view message, Wire wire) : message_(message), wire_(wire) {
  if (wire == Wire::ros1) return;
  const std::string_view header = take(kCdrHeaderBytes);
  const int representation = static_cast<unsigned char>(header[1]);
  if (header[0] != 0 || ((representation & ~1) != kCdr && (representation & ~1) != kCdr2))
    throw MessageError("unknown CDR representation");
  little_endian_ = (representation & 1) != 0;
  greatest_alignment_ = (representation & ~1) == kCdr2 ? 4 : 8;
  // Alignment counts from the end of the header.
  message_.remove_prefix(kCdrHeaderBytes);
  position_ = 0;
}

void WireReader::align(size_t size) {
  if (wire_ == Wire::ros1) return;
  const size_t unit = std::min(size, greatest_alignment_);
  position_ = std::min((position_ + unit - 1) / unit * unit, message_.size());
}

std::string_view WireReader::take(size_t size) {
  if (size > message_.size() - position_) throw MessageError("message ends early");
  const std::string_view bytes = message_.substr(position_, size);
  position_ += size;
  return bytes;
}

std::string_view WireReader::text() {
  std::string_view bytes = take(number<uint32_t>());
  if (wire_ == Wire::cdr && bytes.ends_with('\0')) bytes.remove_suffix(1);
  return bytes;
}

size_t WireReader::count(size_t least_bytes) {
  const size_t elements = number<uint32_t>();
  if (elements > (message_.size() - position_) / least_bytes)
    throw MessageError("a count is larger than the message");
  return elements;
}

}  // namespace hmt::submap
