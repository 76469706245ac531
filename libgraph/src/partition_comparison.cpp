// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/graph/partition_comparison.hpp"

#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "hmt/graph/input_error.hpp"

namespace hmt::graph {
namespace {

double pairs_of(double count) {
  return count * (count - 1) / 2;
}

template <class Counts>
double sum_pairs(const Counts& counts) {
  double sum = 0;
  for (const auto& [key, count] : counts) sum += pairs_of(count);
  return sum;
}

}  // namespace

PartitionComparison compare_partitions(const Labels& a, const Labels& b) {
  if (a.size() != b.size())
    throw InputError("one grouping has " + std::to_string(a.size()) + " nodes and the other " +
                     std::to_string(b.size()) + "; both must be of the same nodes");
  PartitionComparison result;
  if (a.empty()) return result;
  std::map<int, double> count_a;
  std::map<int, double> count_b;
  std::map<std::pair<int, int>, double> count_both;
  for (size_t i = 0; i < a.size(); ++i) {
    ++count_a[a[i]];
    ++count_b[b[i]];
    ++count_both[{a[i], b[i]}];
  }
  const auto n = static_cast<double>(a.size());
  result.nodes = static_cast<int>(a.size());
  result.groups_a = static_cast<int>(count_a.size());
  result.groups_b = static_cast<int>(count_b.size());

  const double both = sum_pairs(count_both);
  const double pairs_a = sum_pairs(count_a);
  const double pairs_b = sum_pairs(count_b);
  const double expected = a.size() < 2 ? 0 : pairs_a * pairs_b / pairs_of(n);
  const double largest = (pairs_a + pairs_b) / 2;
  // Both are one group, or both all singles: equal, and the index is 0 / 0.
  result.adjusted_rand_index = largest == expected ? 1 : (both - expected) / (largest - expected);

  double bits = 0;
  for (const auto& [key, count] : count_both)
    bits -= count / n *
            (std::log2(count / count_a[key.first]) + std::log2(count / count_b[key.second]));
  result.variation_of_information_bits = bits <= 0 ? 0 : bits;
  return result;
}

}  // namespace hmt::graph
