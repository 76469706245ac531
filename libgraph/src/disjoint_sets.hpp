// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace hmt::graph {

/// Sets of numbers 0..n-1, each named by its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), size_t{0});
  }
  size_t find(size_t member) {
    while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
    return member;
  }
  /// Whether they were apart.
  bool join(int a, int b) {
    const size_t set_a = find(static_cast<size_t>(a));
    const size_t set_b = find(static_cast<size_t>(b));
    parent_[std::max(set_a, set_b)] = std::min(set_a, set_b);
    return set_a != set_b;
  }

 private:
  std::vector<size_t> parent_;
};

}  // namespace hmt::graph
