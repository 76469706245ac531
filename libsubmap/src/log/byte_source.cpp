// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <zstd.h>

#include <boost/iostreams/categories.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/read.hpp>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <vector>

#include "hmt/graph/input_error.hpp"
#include "line_source.hpp"

namespace hmt::submap {
namespace {

namespace io = boost::iostreams;

constexpr size_t kHeadBytes = 4096;

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& reason) {
  throw graph::InputError(path.string() + ": " + reason);
}

/// The file's own bytes, as a Boost.Iostreams source.
class File {
 public:
  using char_type = char;
  using category = io::source_tag;

  explicit File(const std::filesystem::path& path)
      : path_(path), file_(std::fopen(path.c_str(), "rb"), &std::fclose) {
    if (!file_) refuse(path, std::string("cannot be read: ") + std::strerror(errno));
  }

  std::streamsize read(char* out, std::streamsize size) {
    const size_t count = std::fread(out, 1, static_cast<size_t>(size), file_.get());
    if (count == 0 && std::ferror(file_.get()))
      refuse(path_,
             "reading failed at byte " + std::to_string(bytes_read_) + ": " + std::strerror(errno));
    bytes_read_ += static_cast<int64_t>(count);
    return count > 0 ? static_cast<std::streamsize>(count) : -1;
  }

  /// The first bytes, which are then read again.
  std::string peek(size_t size) {
    std::string head(size, '\0');
    head.resize(std::fread(head.data(), 1, size, file_.get()));
    std::rewind(file_.get());
    return head;
  }

  int64_t bytes_read() const { return bytes_read_; }

 private:
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  int64_t bytes_read_ = 0;
};

std::string damage_text(const File& file) {
  return "compressed data damaged or cut at byte " + std::to_string(file.bytes_read());
}

class PlainSource : public ByteSource {
 public:
  explicit PlainSource(File file) : file_(std::move(file)) {}
  size_t read(char* out, size_t size) override {
    return static_cast<size_t>(
        std::max<std::streamsize>(0, file_.read(out, static_cast<std::streamsize>(size))));
  }
  const std::string& damage() const override { return damage_; }
  int64_t bytes_read() const override { return file_.bytes_read(); }

 private:
  File file_;
  std::string damage_;
};

template <typename Filter>
class CompressedSource : public ByteSource {
 public:
  explicit CompressedSource(File file) : file_(std::move(file)) {}

  size_t read(char* out, size_t size) override {
    if (!damage_.empty()) return 0;
    // A filter that throws does not say how much it had decoded. Bytes up to the first zero were
    // decoded for sure; a text log holds none, so of it nothing before the damage is lost.
    std::memset(out, 0, size);
    try {
      const std::streamsize count =
          io::read(filter_, file_, out, static_cast<std::streamsize>(size));
      return static_cast<size_t>(std::max<std::streamsize>(0, count));
    } catch (const std::ios_base::failure&) {
      damage_ = damage_text(file_);
      return strnlen(out, size);
    }
  }
  const std::string& damage() const override { return damage_; }
  int64_t bytes_read() const override { return file_.bytes_read(); }

 private:
  File file_;
  Filter filter_;
  std::string damage_;
};

/// Reads with libzstd itself: Boost's zstd_decompressor takes a file that was cut for a whole one.
class ZstdSource : public ByteSource {
 public:
  explicit ZstdSource(File file)
      : file_(std::move(file)), context_(ZSTD_createDCtx(), &ZSTD_freeDCtx) {}

  size_t read(char* out, size_t size) override {
    ZSTD_outBuffer output{out, size, 0};
    while (output.pos < size && damage_.empty()) {
      if (!output_waits_ && !refill()) break;
      const size_t result = ZSTD_decompressStream(context_.get(), &output, &input_);
      if (ZSTD_isError(result)) set_damage();
      frame_is_complete_ = result == 0;
      output_waits_ = output.pos == size || input_.pos < input_.size;
    }
    return output.pos;
  }
  const std::string& damage() const override { return damage_; }
  int64_t bytes_read() const override { return file_.bytes_read(); }

 private:
  /// False at the end of the file.
  bool refill() {
    const std::streamsize count =
        file_.read(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
    if (count <= 0 && !frame_is_complete_) set_damage();
    input_ = {bytes_.data(), static_cast<size_t>(std::max<std::streamsize>(0, count)), 0};
    return count > 0;
  }
  void set_damage() { damage_ = damage_text(file_); }

  File file_;
  std::unique_ptr<ZSTD_DCtx, size_t (*)(ZSTD_DCtx*)> context_;
  std::vector<char> bytes_ = std::vector<char>(ZSTD_DStreamInSize());
  ZSTD_inBuffer input_{nullptr, 0, 0};
  bool output_waits_ = false;  ///< the last call may have left output or input behind
  bool frame_is_complete_ = true;
  std::string damage_;
};

}  // namespace

std::unique_ptr<ByteSource> open_bytes(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) refuse(path, "no such file");
  if (std::filesystem::is_directory(status)) refuse(path, "is a folder, not a log file");
  File file(path);
  const std::string head = file.peek(4);
  if (head.empty()) refuse(path, "the file is empty");
  if (head.starts_with("\x1f\x8b"))
    return std::make_unique<CompressedSource<io::gzip_decompressor>>(std::move(file));
  if (head.starts_with("BZh"))
    return std::make_unique<CompressedSource<io::bzip2_decompressor>>(std::move(file));
  if (head == "\x28\xb5\x2f\xfd") return std::make_unique<ZstdSource>(std::move(file));
  return std::make_unique<PlainSource>(std::move(file));
}

std::string first_bytes(const std::filesystem::path& path) {
  std::string head(kHeadBytes, '\0');
  head.resize(open_bytes(path)->read(head.data(), head.size()));
  return head;
}

}  // namespace hmt::submap
