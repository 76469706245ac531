// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

namespace hmt::submap {

/// Bytes of a file, or of all files directly in a folder, for progress.
int64_t file_bytes(const std::filesystem::path& path);

}  // namespace hmt::submap
