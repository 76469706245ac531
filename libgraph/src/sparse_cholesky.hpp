// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/SparseCore>
#include <optional>

namespace hmt::graph {

/// L of L L^T = A for the lower triangle of a symmetric A, eliminated in the order given; the first
/// entry of a column is its pivot, the second one the parent in the elimination tree. Nothing where
/// A is not positive definite beyond rounding. By CHOLMOD on the calling thread.
std::optional<Eigen::SparseMatrix<double>> cholesky_factor(const Eigen::SparseMatrix<double>& A);

/// Condition number of A (largest by smallest eigenvalue) from below, by power iteration with its
/// lower triangle and its factor L; 1 where A is empty. The eigenvalues come within some percent.
double condition_number(const Eigen::SparseMatrix<double>& A, const Eigen::SparseMatrix<double>& L);

/// X of L L^T X = B. May be called by several threads at a time.
Eigen::MatrixXd solve_with_factor(const Eigen::SparseMatrix<double>& L, Eigen::MatrixXd B);

}  // namespace hmt::graph
