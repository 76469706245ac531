// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "hmt/submap/log/log_reader.hpp"

namespace hmt::test {

/// All observations of a log, or the first `most`.
inline std::vector<submap::Observation> read_log(const std::filesystem::path& path,
                                                 size_t most = SIZE_MAX) {
  std::vector<submap::Observation> observations;
  const auto reader = submap::open_log(path);
  while (observations.size() < most) {
    auto observation = reader->next();
    if (!observation) break;
    observations.push_back(std::move(*observation));
  }
  return observations;
}

}  // namespace hmt::test
