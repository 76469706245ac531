// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "../text_fields.hpp"
#include "point_layout.hpp"

namespace hmt::submap {

/// Splits the next line off, without its end; nothing at the end of the text.
inline std::optional<std::string_view> take_line(std::string_view& text) {
  if (text.empty()) return std::nullopt;
  const size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// Adds the points of up to `count` lines of numbers; coordinate k stands in column columns[k].
void add_ascii_points(std::string_view text, uint64_t count, const std::array<size_t, 3>& columns,
                      CloudPoints& cloud);

/// What is wrong with a cloud that has fewer points than its header tells.
inline std::string missing_points(uint64_t there, uint64_t told) {
  return there < told ? "clouds cut: fewer points than the header tells" : "";
}

}  // namespace hmt::submap
