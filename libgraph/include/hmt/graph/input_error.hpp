// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace hmt::graph {

/// Bad input: a file, an option or an argument that the caller can correct. The message names the
/// file, the line or byte, the value and what to do; the command line prints it as one line and
/// exits with 1.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hmt::graph
