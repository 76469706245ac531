// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace hmt::submap {

/// Appends a blank and the number with that many decimals, the same in every locale.
void append_number(std::string& out, double value, int decimals);

/// Appends the stamp with as many decimals as give the same number when read again, at least six.
void append_stamp(std::string& out, double stamp_s);

/// The shortest text that gives the same number when read again.
std::string number_text(double value);

/// The number with that many decimals, for people.
std::string fixed_text(double value, int decimals);

}  // namespace hmt::submap
