// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "g2o_lines.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// Text of a damaged file for a message: short and printable.
std::string quoted(std::string_view text) {
  std::string shown(text.substr(0, 40));
  for (char& c : shown)
    if (std::isprint(static_cast<unsigned char>(c)) == 0) c = '?';
  return "'" + shown + (text.size() > 40 ? "...'" : "'");
}

bool is_tag(std::string_view text) {
  const auto allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == ':' || c == '-' || c == '.';
  };
  return std::isalpha(static_cast<unsigned char>(text.front())) != 0 &&
         std::all_of(text.begin(), text.end(), allowed);
}

}  // namespace

void LineReader::fail(const std::string& reason) const {
  throw InputError(name_ + ":" + std::to_string(line_) + ": " + reason);
}

bool LineReader::next_line() {
  while (!rest_.empty()) {
    const size_t end = std::min(rest_.find('\n'), rest_.size());
    present_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    present_ = present_.substr(0, present_.find('#'));
    if (more()) return true;
  }
  return false;
}

bool LineReader::more() {
  while (!present_.empty() && is_space(present_.front())) present_.remove_prefix(1);
  return !present_.empty();
}

std::string_view LineReader::field() {
  if (!more()) fail(tag_ + " line ends too early; the file may be cut off");
  const auto end = std::find_if(present_.begin(), present_.end(), is_space);
  const std::string_view text(present_.begin(), end);
  present_.remove_prefix(text.size());
  return text;
}

std::string_view LineReader::tag() {
  const std::string_view text = field();
  if (!is_tag(text)) fail("the line starts with " + quoted(text) + " instead of a g2o tag");
  tag_ = text;
  return text;
}

int64_t LineReader::id() {
  const std::string_view text = field();
  int64_t value = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < 0)
    fail(tag_ + ": " + quoted(text) + " is not a vertex id (an integer from 0)");
  return value;
}

double LineReader::number(std::string_view text) const {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  // A number too small for a double is reported like one too large; strtod tells them apart.
  if (error == std::errc::result_out_of_range)
    value = std::strtod(std::string(digits).c_str(), nullptr);
  else if (error != std::errc{})
    fail(tag_ + ": " + quoted(text) + " is not a number");
  if (end != digits.data() + digits.size()) fail(tag_ + ": " + quoted(text) + " is not a number");
  if (!std::isfinite(value)) fail(tag_ + ": " + quoted(text) + " is not a finite number");
  return value;
}

void LineReader::numbers(std::span<double> values) {
  for (size_t k = 0; k < values.size(); ++k) {
    if (!more())
      fail(tag_ + " has " + std::to_string(k) + " numbers after the ids instead of " +
           std::to_string(values.size()) + "; the line may be cut off");
    values[k] = number(field());
  }
  if (more())
    fail(tag_ + " has more than " + std::to_string(values.size()) +
         " numbers after the ids: " + quoted(present_));
}

}  // namespace hmt::graph
