// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "natural_order.hpp"

#include <algorithm>

#include "hmt/graph/input_error.hpp"

namespace hmt::submap {
namespace {

namespace fs = std::filesystem;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Splits a run of digits, or one other character, off the front.
std::string_view take_part(std::string_view& name) {
  size_t length = 1;
  if (is_digit(name.front()))
    while (length < name.size() && is_digit(name[length])) ++length;
  const std::string_view part = name.substr(0, length);
  name.remove_prefix(length);
  return part;
}

std::string_view without_zeros(std::string_view digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

/// < 0, 0, > 0 as the part of one name lies before, at or behind that of another.
int compare_parts(std::string_view a, std::string_view b) {
  if (!is_digit(a.front()) || !is_digit(b.front())) return a.compare(b);
  a = without_zeros(a);
  b = without_zeros(b);
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.compare(b);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::string_view rest_a = a;
  std::string_view rest_b = b;
  while (!rest_a.empty() && !rest_b.empty()) {
    const int order = compare_parts(take_part(rest_a), take_part(rest_b));
    if (order != 0) return order < 0;
  }
  if (rest_a.empty() != rest_b.empty()) return rest_a.empty();
  return a < b;  // "01" and "1"
}

std::vector<fs::path> files_in_natural_order(const fs::path& folder,
                                             std::initializer_list<std::string_view> extensions) {
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string extension = entry.path().extension().string();
    if (entry.is_regular_file(error) &&
        std::ranges::find(extensions, extension) != extensions.end())
      files.push_back(entry.path());
  }
  if (error) throw graph::InputError(folder.string() + ": cannot be read: " + error.message());
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

}  // namespace hmt::submap
