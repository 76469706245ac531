// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>

namespace hmt::submap {

/// Running 64-bit checksum: FNV-1a over 64-bit words with one more mixing step, so that every
/// change of a single word is seen. Guards against damage, not against forgery.
class Digest {
 public:
  void add(uint64_t word) {
    state_ = (state_ ^ word) * 0x100000001b3u;
    state_ ^= state_ >> 32;
  }
  void add(int64_t value) { add(static_cast<uint64_t>(value)); }
  void add(double value) {
    // A map file keeps no more of a NaN than that it is one.
    add(std::bit_cast<uint64_t>(std::isnan(value) ? std::numeric_limits<double>::quiet_NaN()
                                                  : value));
  }
  void add(std::string_view bytes) {
    add(static_cast<uint64_t>(bytes.size()));
    for (size_t at = 0; at < bytes.size(); at += sizeof(uint64_t)) {
      uint64_t word = 0;
      std::memcpy(&word, bytes.data() + at, std::min(sizeof(word), bytes.size() - at));
      add(word);
    }
  }
  uint64_t value() const { return state_; }

 private:
  uint64_t state_ = 0xcbf29ce484222325u;
};

/// Checksum of one block of bytes.
inline uint64_t digest_of(std::string_view bytes) {
  Digest digest;
  digest.add(bytes);
  return digest.value();
}

}  // namespace hmt::submap
