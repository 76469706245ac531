// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <vector>

#include "elimination_tree.hpp"

namespace hmt::graph {

/// Blocks of the inverse of H = L L^T, column after column: each thread keeps the last column of
/// blocks as far as it was needed. Safe for many threads.
template <int kSize>
class InverseColumns {
 public:
  using Block = Eigen::Matrix<double, kSize, kSize>;

  /// Block of H^-1 in the rows from `b` on and the columns from `a` on. The thread keeps the
  /// columns of `a` until it asks for others: back substitution needs of the rows only those from b
  /// up to the root of the elimination tree, most of which the last b has in common with this one.
  Block block(const Eigen::SparseMatrix<double>& L, int b, int a) const {
    Column& column = column_.local();
    if (column.first != a) start(L, a, column);
    std::vector<int>& path = column.path;
    path.clear();
    for (int k = b; k < b + kSize; ++k)
      for (int j = k; j >= 0 && column.is_done[static_cast<size_t>(j)] == 0; j = parent(L, j)) {
        column.is_done[static_cast<size_t>(j)] = 1;
        path.push_back(j);
      }
    // Ascending within each stretch, and each stretch ends where one before it went on.
    std::sort(path.begin(), path.end());
    for (auto j = path.rbegin(); j != path.rend(); ++j)
      back_substitute<kSize>(L, *j, column.values);
    column.touched.insert(column.touched.end(), path.begin(), path.end());
    return column.values.template middleRows<kSize>(b);
  }

 private:
  struct Column {
    int first = -1;
    ColumnsOf<kSize> values;    ///< on the way L^-1 E, in the end L^-T L^-1 E; zero elsewhere
    std::vector<char> is_done;  ///< one a row
    std::vector<int> touched;   ///< rows that are not zero or done
    std::vector<int> path;      ///< of the last row asked for
  };

  /// L^-1 times the unit columns from `a` on.
  static void start(const Eigen::SparseMatrix<double>& L, int a, Column& column) {
    if (column.values.rows() != L.rows()) {
      column.values.setZero(L.rows(), kSize);
      column.is_done.assign(static_cast<size_t>(L.rows()), 0);
    }
    for (const int j : column.touched) {
      column.values.row(j).setZero();
      column.is_done[static_cast<size_t>(j)] = 0;
    }
    column.first = a;
    column.touched.clear();
    append_path(L, a, kSize, column.touched);
    column.values.template middleRows<kSize>(a).setIdentity();
    for (const int j : column.touched) column.values.row(j) = eliminate<kSize>(L, j, column.values);
  }

  mutable tbb::enumerable_thread_specific<Column> column_;
};

}  // namespace hmt::graph
