// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace hmt::graph {

/// Walks a text line by line and takes fields from the present line. Every failure is an InputError
/// that names the file, the line and the field.
class LineReader {
 public:
  LineReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  /// Moves to the next line that holds a field; false at the end of the text.
  bool next_line();
  int64_t line() const { return line_; }

  /// The first field of the line.
  std::string_view tag();
  /// An integer in [0, 2^63).
  int64_t id();
  /// Whether the line holds another field.
  bool more();
  /// Exactly as many finite numbers as `values` takes; the line must end there.
  void numbers(std::span<double> values);

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  std::string_view field();
  double number(std::string_view text) const;

  std::string_view rest_;
  std::string_view present_;
  std::string name_;
  std::string tag_;
  int64_t line_ = 0;
};

}  // namespace hmt::graph
