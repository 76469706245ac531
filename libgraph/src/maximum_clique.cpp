// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "maximum_clique.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>

namespace hmt::graph {
namespace {

/// Set of nodes as bits.
class NodeSet {
 public:
  explicit NodeSet(size_t size) : words_((size + 63) / 64, 0) {}

  void insert(size_t node) { words_[node / 64] |= uint64_t{1} << node % 64; }
  void erase(size_t node) { words_[node / 64] &= ~(uint64_t{1} << node % 64); }
  /// Smallest node, or -1.
  int first() const {
    for (size_t w = 0; w < words_.size(); ++w)
      if (words_[w] != 0) return static_cast<int>(64 * w) + std::countr_zero(words_[w]);
    return -1;
  }
  NodeSet intersection(const NodeSet& other) const {
    NodeSet both = *this;
    for (size_t w = 0; w < words_.size(); ++w) both.words_[w] &= other.words_[w];
    return both;
  }
  void subtract(const NodeSet& other) {
    for (size_t w = 0; w < words_.size(); ++w) words_[w] &= ~other.words_[w];
  }

 private:
  std::vector<uint64_t> words_;
};

class CliqueSearch {
 public:
  CliqueSearch(const std::vector<std::vector<bool>>& adjacent, long max_branches)
      : branches_left_(max_branches) {
    for (size_t a = 0; a < adjacent.size(); ++a) {
      NodeSet row(adjacent.size());
      for (size_t b = 0; b < adjacent.size(); ++b)
        if (a != b && adjacent[a][b]) row.insert(b);
      neighbors_.push_back(row);
    }
  }

  std::vector<int> run() {
    NodeSet all(neighbors_.size());
    for (size_t node = 0; node < neighbors_.size(); ++node) all.insert(node);
    grow(all);
    return best_;
  }

 private:
  /// Tries the candidates in ascending order, so cliques come in lexicographic order and the first
  /// of the largest size stays.
  void grow(NodeSet candidates) {
    for (int node = candidates.first(); node >= 0; node = candidates.first()) {
      if (clique_.size() + colors(candidates, best_.size()) <= best_.size()) return;
      if (branches_left_-- <= 0) return;
      candidates.erase(static_cast<size_t>(node));
      clique_.push_back(node);
      if (clique_.size() > best_.size()) best_ = clique_;
      grow(candidates.intersection(neighbors_[static_cast<size_t>(node)]));
      clique_.pop_back();
    }
  }

  /// Colors of a greedy coloring: no clique has more nodes. Counting stops beyond `enough`.
  size_t colors(NodeSet rest, size_t enough) const {
    size_t count = 0;
    while (rest.first() >= 0 && clique_.size() + count <= enough) {
      ++count;
      NodeSet free = rest;
      for (int node = free.first(); node >= 0; node = free.first()) {
        rest.erase(static_cast<size_t>(node));
        free.erase(static_cast<size_t>(node));
        free.subtract(neighbors_[static_cast<size_t>(node)]);
      }
    }
    return count;
  }

  std::vector<NodeSet> neighbors_;
  long branches_left_;
  std::vector<int> clique_;
  std::vector<int> best_;
};

}  // namespace

std::vector<int> maximum_clique(const std::vector<std::vector<bool>>& adjacent, long max_branches) {
  return CliqueSearch(adjacent, max_branches).run();
}

}  // namespace hmt::graph
