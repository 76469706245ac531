// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace hmt::graph {

// Steps along the elimination tree of a Cholesky factor L by columns, for kSize columns at a time.

template <int kSize>
using RowOf = Eigen::Matrix<double, 1, kSize>;
template <int kSize>
using ColumnsOf = Eigen::Matrix<double, Eigen::Dynamic, kSize, Eigen::RowMajor>;

/// x_j of L x = y, y in `values`, taken out of the rows below.
template <int kSize>
RowOf<kSize> eliminate(const Eigen::SparseMatrix<double>& L, int j, ColumnsOf<kSize>& values) {
  int entry = L.outerIndexPtr()[j];
  const RowOf<kSize> x_j = values.row(j) / L.valuePtr()[entry];
  for (++entry; entry < L.outerIndexPtr()[j + 1]; ++entry)
    values.row(L.innerIndexPtr()[entry]) -= L.valuePtr()[entry] * x_j;
  return x_j;
}

/// x_j of L^T x = y in place, the rows below being solved.
template <int kSize>
void back_substitute(const Eigen::SparseMatrix<double>& L, int j, ColumnsOf<kSize>& values) {
  const int diagonal = L.outerIndexPtr()[j];
  RowOf<kSize> x_j = values.row(j);
  for (int entry = diagonal + 1; entry < L.outerIndexPtr()[j + 1]; ++entry)
    x_j -= L.valuePtr()[entry] * values.row(L.innerIndexPtr()[entry]);
  values.row(j) = x_j / L.valuePtr()[diagonal];
}

/// Of a column in the elimination tree: its first entry below the diagonal; -1 for a root.
inline int parent(const Eigen::SparseMatrix<double>& L, int j) {
  const int entry = L.outerIndexPtr()[j] + 1;
  return entry < L.outerIndexPtr()[j + 1] ? L.innerIndexPtr()[entry] : -1;
}

/// Appends the rows first..first+count-1 and those above the last of them in the tree, ascending.
inline void append_path(const Eigen::SparseMatrix<double>& L, int first, int count,
                        std::vector<int>& path) {
  for (int k = 0; k < count; ++k) path.push_back(first + k);
  for (int j = parent(L, path.back()); j >= 0; j = parent(L, j)) path.push_back(j);
}

}  // namespace hmt::graph
