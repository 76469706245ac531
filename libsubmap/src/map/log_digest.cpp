// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "digest.hpp"
#include "hmt/submap/map/map_file.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

constexpr size_t kBlockBytes = size_t{64} << 10;
// Files up to kMaxBlocks * kBlockBytes = 64 MB are read whole.
constexpr uint64_t kMaxBlocks = 1024;

void add_file(const fs::path& path, Digest& digest) {
  std::ifstream in(path, std::ios::binary);
  std::error_code error;
  const uint64_t size = fs::file_size(path, error);
  if (!in || error) throw InputError(path.string() + ": cannot be read; check its permissions");
  digest.add(size);
  const uint64_t blocks = std::max<uint64_t>(1, (size + kBlockBytes - 1) / kBlockBytes);
  const uint64_t read = std::min(blocks, kMaxBlocks);
  std::string block(kBlockBytes, '\0');
  for (uint64_t k = 0; k < read; ++k) {
    // The first and the last block are always among them.
    const uint64_t at = read == 1 ? 0 : k * (blocks - 1) / (read - 1);
    in.seekg(static_cast<std::streamoff>(at * kBlockBytes));
    in.read(block.data(), static_cast<std::streamsize>(kBlockBytes));
    digest.add(std::string_view(block.data(), static_cast<size_t>(in.gcount())));
    if (in.bad()) throw InputError(path.string() + ": cannot be read to its end");
    in.clear();
  }
}

}  // namespace

std::string log_digest(const fs::path& log) {
  Digest digest;
  std::error_code error;
  if (fs::is_directory(log, error)) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(log, error))
      if (entry.is_regular_file(error)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
      digest.add(std::string_view(file.lexically_relative(log).generic_string()));
      add_file(file, digest);
    }
  } else {
    add_file(log, digest);
  }
  char text[17];
  std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(digest.value()));
  return text;
}

}  // namespace hmt::submap
