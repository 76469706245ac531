// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hmt::submap {

/// How a block of a recording is compressed.
enum class Codec { none, bz2, lz4, zstd };

/// What a block may hold at most: 64 MB and 100 times its compressed bytes, and never more than
/// 1 GB. Honest blocks hold some megabytes; a small file must not fill the memory.
uint64_t most_decoded_bytes(uint64_t encoded_bytes);

struct Decoded {
  std::string bytes;   ///< up to the damage, if there is any
  std::string damage;  ///< why it ends early; empty where it does not
};

/// Decodes one block. Memory follows what is really in it, not `claimed_bytes`; a block of another
/// size than claimed is damaged.
Decoded decompress(Codec codec, std::string_view encoded, uint64_t claimed_bytes);

}  // namespace hmt::submap
