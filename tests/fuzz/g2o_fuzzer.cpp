// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
// Any bytes are either read as a pose graph, which then survives being written and read again, or
// refused with an InputError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "hmt/graph/g2o_file.hpp"
#include "hmt/graph/input_error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace hmt::graph;
  try {
    const G2oFile file =
        parse_g2o(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz");
    const G2oFile again = parse_g2o(format_g2o(file), "written");
    if (again.ids != file.ids || again.graph.edges.size() != file.graph.edges.size()) std::abort();
  } catch (const InputError& error) {
    // What we wrote ourselves must be readable.
    if (std::string_view(error.what()).starts_with("written")) std::abort();
  }
  return 0;
}
