// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "hmt/graph/weighted_graph.hpp"

namespace hmt::graph {

/// Reads the weight matrix Omega from a Matrix Market file, plain or gzip (told by its first
/// bytes): coordinate format; real, integer or pattern (every entry 1); symmetric (either triangle)
/// or general (both triangles, which must agree exactly). Row i + 1 of the file is node i.
///
/// Throws InputError naming file, line, and row and column as in the file, for: entries that are
/// NaN, infinite or negative, outside the matrix, on the diagonal and not zero, given twice; a
/// general matrix that is not symmetric; a matrix that is not square or has more than 10^7 rows; a
/// file that ends early, holds more entries than it says, or is no Matrix Market file.
WeightedGraph read_matrix_market(const std::filesystem::path& path);

/// True where the file starts as a Matrix Market file, plain or gzip; false also where it cannot be
/// read.
bool is_matrix_market(const std::filesystem::path& path);

}  // namespace hmt::graph
