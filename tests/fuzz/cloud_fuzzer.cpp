// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Any bytes are either read as a cloud of finite points, no more than there are bytes, or refused.
#include <cstdint>
#include <cstdlib>

#include "hmt/graph/input_error.hpp"
#include "log/cloud/cloud_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hmt::submap;
  const std::string_view file(reinterpret_cast<const char*>(data), size);
  for (const auto read : {read_pcd, read_ply, read_kitti_bin}) {
    try {
      const CloudPoints cloud = read(file);
      // LZF makes at most 88 bytes of one, and a point takes at least four.
      if (cloud.points.size() > 22 * size) std::abort();
      for (const auto& p : cloud.points)
        if (!p.allFinite()) std::abort();
    } catch (const hmt::graph::InputError&) {
    }
  }
  return 0;
}
