// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/graph/partition.hpp"

namespace hmt::graph {

/// How alike two groupings of the same nodes are; the numbers of the groups do not matter.
struct PartitionComparison {
  int nodes = 0;
  int groups_a = 0;
  int groups_b = 0;
  /// Adjusted Rand index [Hubert 1985]: 1 for equal groupings, 0 on average for random ones with
  /// the same group sizes, negative for less than that.
  double adjusted_rand_index = 1;
  /// Variation of information H(A|B) + H(B|A) [Meila 2007] in bits: 0 for equal groupings, at most
  /// log2 of the number of nodes.
  double variation_of_information_bits = 0;
};

/// Compares two groupings; empty ones are equal. O(n log n). Throws InputError where their lengths
/// differ.
PartitionComparison compare_partitions(const Labels& a, const Labels& b);

}  // namespace hmt::graph
