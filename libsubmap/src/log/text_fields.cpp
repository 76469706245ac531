// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "text_fields.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace hmt::submap {
namespace {

constexpr std::string_view kBlanks = " \t\r";

template <typename Number>
std::optional<Number> parse(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) return std::nullopt;
  return value;
}

}  // namespace

std::optional<double> to_number(std::string_view field) {
  return parse<double>(field);
}

std::optional<int64_t> to_count(std::string_view field) {
  const auto value = parse<int64_t>(field);
  return value && *value >= 0 ? value : std::nullopt;
}

std::string_view take_field(std::string_view& fields) {
  const size_t begin = fields.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) {
    fields = {};
    return {};
  }
  const size_t end = std::min(fields.find_first_of(kBlanks, begin), fields.size());
  const std::string_view field = fields.substr(begin, end - begin);
  fields.remove_prefix(end);
  return field;
}

std::string_view without_comment(std::string_view line) {
  line = line.substr(0, line.find('#'));
  const size_t begin = line.find_first_not_of(kBlanks);
  return begin == std::string_view::npos ? std::string_view{} : line.substr(begin);
}

double take_number(std::string_view& fields, const char* name) {
  const std::string_view field = take_field(fields);
  if (field.empty()) throw std::invalid_argument(std::string("line ends before ") + name);
  if (const auto value = to_number(field)) return *value;
  throw std::invalid_argument(std::string(name) + " is not a number");
}

int64_t take_count(std::string_view& fields, const char* name) {
  if (const auto value = to_count(take_field(fields))) return *value;
  throw std::invalid_argument(std::string(name) + " is not a count");
}

double take_finite(std::string_view& fields, const char* name) {
  const double value = take_number(fields, name);
  if (!std::isfinite(value)) throw std::invalid_argument(std::string(name) + " is not finite");
  return value;
}

}  // namespace hmt::submap
