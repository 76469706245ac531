// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// Text of a labels file: line i + 1 is the group of node i.
std::string labels_text(const Labels& labels);

/// Reads the groups of nodes, plain or gzip: a labels file (one whole number a line, any numbering)
/// or a partition table (header `keyframe,stamp_s,submap`, its last column). The groups come as
/// canonical labels. Throws InputError naming file and line.
Labels read_labels(const std::filesystem::path& path);

/// True where the first line of the file is one of the two that read_labels takes.
bool is_labels_file(const std::filesystem::path& path);

}  // namespace hmt::graph
