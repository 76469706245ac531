// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fiedler.hpp"

#include <Spectra/SymEigsSolver.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

#include "laplacian_factor.hpp"
#include "multilevel_fiedler.hpp"

namespace hmt::graph {
namespace {

// Up to this size all eigenpairs are computed at once.
constexpr int kAllPairsSize = 20;
// Vectors of a Lanczos run before it is restarted. One run or two is enough where lambda_2 is apart
// from lambda_3; a cluster of eigenvalues that is not told apart by the last restart is left to the
// multilevel solver, to which any vector of the cluster is as good.
constexpr int kVectors = 12;
constexpr int kMaxRestarts = 20;
// Ritz residual of the inverse relative to its Ritz value at which the pair counts as converged.
constexpr double kTolerance = 1e-9;

Eigen::VectorXd null_vector(const CsrGraph& graph) {
  Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(graph.degrees.data(), graph.size());
  v = v.cwiseSqrt();
  return v.normalized();
}

void set_residual(const CsrGraph& graph, FiedlerPairs& pairs) {
  Eigen::VectorXd product;
  apply_laplacian(graph, pairs.z.col(0), product);
  pairs.lambda[0] = pairs.z.col(0).dot(product);
  pairs.residual = (product - pairs.lambda[0] * pairs.z.col(0)).norm();
}

FiedlerPairs all_pairs(const CsrGraph& graph, int count) {
  const int n = graph.size();
  Eigen::MatrixXd laplacian(n, n);
  Eigen::VectorXd column;
  for (int i = 0; i < n; ++i) {
    apply_laplacian(graph, Eigen::VectorXd::Unit(n, i), column);
    laplacian.col(i) = column;
  }
  // Moves the null pair to the far end of the spectrum, which lies in [0, 2].
  const Eigen::VectorXd null = null_vector(graph);
  laplacian += 3 * null * null.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(laplacian);
  const int kept = std::min(count, n - 1);
  return {solver.eigenvalues().head(kept), solver.eigenvectors().leftCols(kept), 0};
}

// (L + shift I)^-1 on the vectors that are orthogonal to the null vector, as Spectra asks for it.
class DeflatedInverse {
 public:
  using Scalar = double;

  DeflatedInverse(const CsrGraph& graph, LaplacianFactor& factor)
      : factor_(factor), null_(null_vector(graph)) {}
  Eigen::Index rows() const { return null_.size(); }
  Eigen::Index cols() const { return null_.size(); }
  void perform_op(const double* in, double* out) const {
    Eigen::Map<Eigen::VectorXd> x(out, rows());
    factor_.solve(project(Eigen::Map<const Eigen::VectorXd>(in, rows())), solution_);
    x = project(solution_);
  }

 private:
  Eigen::VectorXd project(const Eigen::Ref<const Eigen::VectorXd>& x) const {
    return x - null_ * null_.dot(x);
  }

  LaplacianFactor& factor_;
  Eigen::VectorXd null_;
  mutable Eigen::VectorXd solution_;
};

// The eigenvector's sign is arbitrary: the entry of largest magnitude is made positive (the first
// of equals).
void fix_signs(Eigen::MatrixXd& z) {
  for (int k = 0; k < z.cols(); ++k) {
    Eigen::Index largest = 0;
    z.col(k).cwiseAbs().maxCoeff(&largest);
    if (z(largest, k) < 0) z.col(k) *= -1;
  }
}

}  // namespace

Eigen::VectorXd start_vector(int n) {
  std::minstd_rand random(1);
  Eigen::VectorXd v(n);
  for (int i = 0; i < n; ++i)
    v[i] = static_cast<double>(random()) / static_cast<double>(std::minstd_rand::max()) - 0.5;
  return v;
}

FiedlerPairs lanczos_pairs(const CsrGraph& graph, LaplacianFactor& factor, int count) {
  DeflatedInverse inverse(graph, factor);
  const int vectors = std::min(kVectors, graph.size());
  Spectra::SymEigsSolver<DeflatedInverse> solver(inverse, std::min(count, vectors - 1), vectors);
  const Eigen::VectorXd start = start_vector(graph.size());
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestAlge, kMaxRestarts, kTolerance);
  const Eigen::ArrayXd inverses = solver.eigenvalues();
  return {inverses.inverse() - kLanczosShift, solver.eigenvectors(), 0};
}

FiedlerSolver::FiedlerSolver(const CsrGraph& graph) : graph_(graph) {
  if (graph.size() > kAllPairsSize) factor_ = factorize_laplacian(graph, kLanczosShift);
}

FiedlerPairs FiedlerSolver::pairs(int count) {
  FiedlerPairs result;
  if (graph_.size() <= kAllPairsSize)
    result = all_pairs(graph_, count);
  else if (factor_)
    result = lanczos_pairs(graph_, *factor_, count);
  if (result.lambda.size() == 0) result = multilevel_fiedler(graph_);
  fix_signs(result.z);
  set_residual(graph_, result);
  return result;
}

}  // namespace hmt::graph
