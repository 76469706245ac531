// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "sparse_cholesky.hpp"

#include <Eigen/CholmodSupport>
#include <cmath>
#include <utility>

#include "openmp_guard.hpp"

namespace hmt::graph {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// A pivot below this share of its diagonal entry is zero up to the rounding of the elimination.
constexpr double kSingularPivot = 1e-13;

/// Power iteration ends at this many steps, or where a step changes the eigenvalue by less than a
/// share: only the magnitude of a condition number matters.
constexpr int kPowerIterations = 30;
constexpr double kWorthlessChange = 1e-3;

/// CHOLMOD's factor as columns. Its supernodal factor is many times as fast to compute as one of
/// columns, which alone can be walked along the elimination tree.
class ColumnFactor : public Eigen::CholmodDecomposition<SparseMatrix, Eigen::Lower> {
 public:
  explicit ColumnFactor(const SparseMatrix& A) {
    cholmod().print = 0;
    cholmod().nmethods = 1;
    cholmod().method[0].ordering = CHOLMOD_NATURAL;
    cholmod().postorder = 0;
    cholmod().final_asis = 0;
    cholmod().final_ll = 1;
    cholmod().final_super = 0;
    // The zeros within the supernodes are not of use to columns.
    cholmod().final_resymbol = 1;
    compute(A);
  }

  std::optional<SparseMatrix> columns() const {
    if (info() != Eigen::Success) return std::nullopt;
    const cholmod_factor& factor = *m_cholmodFactor;
    const auto n = static_cast<Eigen::Index>(factor.n);
    const auto* const starts = static_cast<const int*>(factor.p);
    return Eigen::Map<const SparseMatrix>(n, n, starts[n], starts,
                                          static_cast<const int*>(factor.i),
                                          static_cast<const double*>(factor.x));
  }
};

/// Largest eigenvalue of a positive definite operator of that size.
template <class Operator>
double largest_eigenvalue(Eigen::Index size, const Operator& multiply) {
  // Uneven, so that no eigenvector of a regular graph is orthogonal to it.
  Eigen::VectorXd x(size);
  for (Eigen::Index i = 0; i < size; ++i) x[i] = 1 + 0.5 * std::sin(static_cast<double>(i * i));
  double norm = 0;
  for (int k = 0; k < kPowerIterations; ++k) {
    x /= x.norm();
    x = multiply(x);
    const double before = std::exchange(norm, x.norm());
    if (std::abs(norm - before) <= kWorthlessChange * norm) break;
  }
  return norm;
}

}  // namespace

std::optional<SparseMatrix> cholesky_factor(const SparseMatrix& A) {
  // CHOLMOD does not take an empty system.
  if (A.cols() == 0) return A;
  const OpenMpGuard guard;
  std::optional<SparseMatrix> L = ColumnFactor(A).columns();
  for (Eigen::Index j = 0; L && j < A.cols(); ++j) {
    const double pivot = L->valuePtr()[L->outerIndexPtr()[j]];
    if (!(pivot * pivot > kSingularPivot * A.coeff(j, j))) return std::nullopt;
  }
  return L;
}

Eigen::MatrixXd solve_with_factor(const SparseMatrix& L, Eigen::MatrixXd B) {
  L.triangularView<Eigen::Lower>().solveInPlace(B);
  L.transpose().triangularView<Eigen::Upper>().solveInPlace(B);
  return B;
}

double condition_number(const SparseMatrix& A, const SparseMatrix& L) {
  if (L.cols() == 0) return 1;
  const double largest =
      largest_eigenvalue(L.cols(), [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        return A.selfadjointView<Eigen::Lower>() * x;
      });
  return largest * largest_eigenvalue(L.cols(), [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
           return solve_with_factor(L, x);
         });
}

}  // namespace hmt::graph
