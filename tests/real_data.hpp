// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace hmt::test {

/// Folder of the real logs, whether it exists or not.
inline std::filesystem::path data_dir() {
  return HMTMAP_DATA_DIR;
}

/// True in continuous integration, where the real logs must be there.
inline bool in_ci() {
  const char* ci = std::getenv("CI");
  return ci != nullptr && std::string(ci) == "true";
}

}  // namespace hmt::test

/// Skips the test with a clear message where the real file is absent; fails instead if CI=true.
#define HMT_REQUIRE_REAL_DATA(relative_path)                                        \
  do {                                                                              \
    if (!std::filesystem::exists(hmt::test::data_dir() / (relative_path))) {        \
      if (hmt::test::in_ci())                                                       \
        FAIL() << "missing real data: " << hmt::test::data_dir() / (relative_path); \
      GTEST_SKIP() << "needs " << hmt::test::data_dir() / (relative_path);          \
    }                                                                               \
  } while (false)
