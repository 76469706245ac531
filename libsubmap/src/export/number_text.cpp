// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "number_text.hpp"

#include <array>
#include <charconv>

namespace hmt::submap {
namespace {

constexpr size_t kLeastStampDecimals = 6;
/// The longest double without an exponent has 309 digits, a sign, a point and its decimals.
using Digits = std::array<char, 400>;

}  // namespace

void append_number(std::string& out, double value, int decimals) {
  Digits digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::fixed, decimals)
                       .ptr;
  out += ' ';
  out.append(digits.data(), end);
}

void append_stamp(std::string& out, double stamp_s) {
  Digits digits;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), stamp_s, std::chars_format::fixed)
          .ptr;
  std::string text(digits.data(), end);
  if (text.find('.') == std::string::npos) text += '.';
  const size_t decimals = text.size() - 1 - text.find('.');
  if (decimals < kLeastStampDecimals) text.append(kLeastStampDecimals - decimals, '0');
  out += text;
}

std::string number_text(double value) {
  Digits digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

std::string fixed_text(double value, int decimals) {
  std::string text;
  append_number(text, value, decimals);
  return text.substr(1);
}

}  // namespace hmt::submap
