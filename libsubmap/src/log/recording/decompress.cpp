// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "decompress.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace hmt::submap {
namespace {

constexpr uint64_t kMegabyte = 1 << 20;
constexpr uint64_t kFreeBytes = 64 * kMegabyte;
constexpr uint64_t kMaxRatio = 100;
constexpr uint64_t kMaxBytes = 1024 * kMegabyte;
constexpr size_t kFirstStep = size_t{64} << 10;

/// One step of a decoder: what it took, what it gave, and whether that was the end.
struct Step {
  size_t taken = 0;
  size_t given = 0;
  bool end = false;
};

class Bz2Decoder {
 public:
  Bz2Decoder() { ready_ = BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK; }
  ~Bz2Decoder() {
    if (ready_) BZ2_bzDecompressEnd(&stream_);
  }
  Bz2Decoder(const Bz2Decoder&) = delete;
  Bz2Decoder& operator=(const Bz2Decoder&) = delete;

  /// Nothing for damaged data.
  std::optional<Step> operator()(std::string_view in, char* out, size_t size) {
    if (!ready_) return std::nullopt;
    // bzip2 only reads from here.
    stream_.next_in = const_cast<char*>(in.data());
    stream_.avail_in = static_cast<unsigned>(in.size());
    stream_.next_out = out;
    stream_.avail_out = static_cast<unsigned>(size);
    const int result = BZ2_bzDecompress(&stream_);
    if (result != BZ_OK && result != BZ_STREAM_END) return std::nullopt;
    return Step{in.size() - stream_.avail_in, size - stream_.avail_out, result == BZ_STREAM_END};
  }

 private:
  bz_stream stream_{};
  bool ready_ = false;
};

class Lz4Decoder {
 public:
  Lz4Decoder() { LZ4F_createDecompressionContext(&context_, LZ4F_VERSION); }
  ~Lz4Decoder() { LZ4F_freeDecompressionContext(context_); }
  Lz4Decoder(const Lz4Decoder&) = delete;
  Lz4Decoder& operator=(const Lz4Decoder&) = delete;

  std::optional<Step> operator()(std::string_view in, char* out, size_t size) {
    Step step{in.size(), size, false};
    const size_t hint =
        LZ4F_decompress(context_, out, &step.given, in.data(), &step.taken, nullptr);
    if (LZ4F_isError(hint)) return std::nullopt;
    step.end = hint == 0;
    return step;
  }

 private:
  LZ4F_dctx* context_ = nullptr;
};

class ZstdDecoder {
 public:
  std::optional<Step> operator()(std::string_view in, char* out, size_t size) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out, size, 0};
    const size_t hint = ZSTD_decompressStream(context_.get(), &output, &input);
    if (ZSTD_isError(hint)) return std::nullopt;
    return Step{input.pos, output.pos, hint == 0};
  }

 private:
  std::unique_ptr<ZSTD_DCtx, size_t (*)(ZSTD_DCtx*)> context_{ZSTD_createDCtx(), &ZSTD_freeDCtx};
};

/// Runs a decoder over the whole block, into memory that grows with what comes.
template <typename Decoder>
Decoded run(std::string_view encoded, uint64_t most_bytes) {
  Decoder decode;
  Decoded result;
  size_t filled = 0;
  while (true) {
    if (filled == result.bytes.size()) {
      if (filled >= most_bytes) break;
      result.bytes.resize(std::min<uint64_t>(most_bytes, std::max(kFirstStep, 2 * filled)));
    }
    const auto step = decode(encoded, result.bytes.data() + filled, result.bytes.size() - filled);
    if (!step) {
      result.damage = "compressed data damaged";
      break;
    }
    encoded.remove_prefix(step->taken);
    filled += step->given;
    if (step->end) break;
    if (step->taken == 0 && step->given == 0) {
      result.damage = "compressed data cut";
      break;
    }
  }
  result.bytes.resize(filled);
  return result;
}

Decoded run(Codec codec, std::string_view encoded, uint64_t most_bytes) {
  switch (codec) {
    case Codec::bz2:
      return run<Bz2Decoder>(encoded, most_bytes);
    case Codec::lz4:
      return run<Lz4Decoder>(encoded, most_bytes);
    case Codec::zstd:
      return run<ZstdDecoder>(encoded, most_bytes);
    case Codec::none:
      break;
  }
  return {std::string(encoded.substr(0, most_bytes)), ""};
}

}  // namespace

uint64_t most_decoded_bytes(uint64_t encoded_bytes) {
  return std::min(kMaxBytes, kFreeBytes + kMaxRatio * std::min(encoded_bytes, kMaxBytes));
}

Decoded decompress(Codec codec, std::string_view encoded, uint64_t claimed_bytes) {
  const uint64_t most_bytes = most_decoded_bytes(encoded.size());
  // One byte more than claimed tells a block that is larger.
  Decoded result = run(codec, encoded, std::min(most_bytes, claimed_bytes + 1));
  if (!result.damage.empty()) return result;
  if (result.bytes.size() == claimed_bytes) return result;
  result.damage = claimed_bytes > most_bytes ? "a block claims to hold too much"
                                             : "a block has another size than it claims";
  return result;
}

}  // namespace hmt::submap
