// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hmt::submap {

// Fields of a text line, separated by blanks. Numbers are read the same way in every locale.

/// The whole field as a number, "nan" and "inf" included; nothing where it is none.
std::optional<double> to_number(std::string_view field);
/// The whole field as an integer >= 0.
std::optional<int64_t> to_count(std::string_view field);

/// Splits the first field off `fields`; empty at the end.
std::string_view take_field(std::string_view& fields);
/// Splits the first field off and reads it. Throws std::invalid_argument naming `name`.
double take_number(std::string_view& fields, const char* name);
/// The same for a number that must be finite.
double take_finite(std::string_view& fields, const char* name);
/// The same for an integer >= 0.
int64_t take_count(std::string_view& fields, const char* name);

/// The line without a `#` comment and leading blanks.
std::string_view without_comment(std::string_view line);

}  // namespace hmt::submap
