// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/labels_file.hpp"

#include <charconv>
#include <optional>
#include <string_view>

#include "gzip_lines.hpp"
#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

constexpr std::string_view kTableHeader = "keyframe,stamp_s,submap";

std::string_view trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// The group that a line of a table gives: what follows its second comma.
std::string_view table_group(std::string_view line) {
  const size_t last = line.rfind(',');
  if (last == std::string_view::npos) return {};
  return trimmed(line.substr(last + 1));
}

}  // namespace

std::string labels_text(const Labels& labels) {
  std::string text;
  for (const int label : labels) text.append(std::to_string(label)).append("\n");
  return text;
}

Labels read_labels(const std::filesystem::path& path) {
  GzipLines lines(path);
  Labels labels;
  bool table = false;
  while (const auto line = lines.next()) {
    if (lines.line_number() == 1 && trimmed(*line) == kTableHeader) {
      table = true;
      continue;
    }
    const std::string_view group = table ? table_group(*line) : trimmed(*line);
    const std::optional<int> label = whole_number(group);
    if (!label)
      lines.refuse("the group is '" + std::string(group.substr(0, 40)) +
                   "'; a line must hold the number of one node's group");
    labels.push_back(*label);
  }
  return canonical_labels(labels);
}

bool is_labels_file(const std::filesystem::path& path) {
  try {
    GzipLines lines(path);
    const std::string_view line = trimmed(lines.next().value_or(""));
    return line == kTableHeader || whole_number(line).has_value();
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace hmt::graph
