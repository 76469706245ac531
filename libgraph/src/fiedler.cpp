// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "fiedler.hpp"

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
// Lanczos vectors at most; convergence takes 6 to 15 where lambda_2 is apart from lambda_3.
constexpr int kMaxVectors = 60;
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

// The Lanczos process on (L + shift I)^-1, orthogonal to the null vector, with full
// reorthogonalization.
class Lanczos {
 public:
  Lanczos(const CsrGraph& graph, LaplacianFactor& factor)
      : factor_(factor), null_(null_vector(graph)) {
    basis_.resize(graph.size(), 16);
    Eigen::VectorXd start = start_vector(graph.size());
    start -= null_ * null_.dot(start);
    basis_.col(0) = start.normalized();
  }

  // Runs until the largest Ritz pair has converged or the Krylov space is exhausted.
  FiedlerPairs run(int count) {
    const int limit = std::min(kMaxVectors, static_cast<int>(basis_.rows()) - 1);
    for (int steps = 1;; ++steps) {
      const double beta = step(steps - 1);
      const bool last = steps == limit || beta < 1e-14 * alpha_.front();
      if (!last && (steps < 4 || steps % 2 == 1)) {
        append(beta);
        continue;
      }
      const auto ritz = ritz_pairs(steps);
      const double error = beta * std::abs(ritz.eigenvectors()(steps - 1, steps - 1));
      if (last || error <= kTolerance * ritz.eigenvalues()[steps - 1])
        return pairs(ritz, steps, std::min(count, steps));
      append(beta);
    }
  }

 private:
  using SmallSolver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

  double step(int j) {
    factor_.solve(basis_.col(j), next_);
    alpha_.push_back(basis_.col(j).dot(next_));
    for (int pass = 0; pass < 2; ++pass) {
      next_ -= null_ * null_.dot(next_);
      const Eigen::VectorXd share = basis_.leftCols(j + 1).transpose() * next_;
      next_.noalias() -= basis_.leftCols(j + 1) * share;
    }
    return next_.norm();
  }

  void append(double beta) {
    beta_.push_back(beta);
    const auto used = static_cast<int>(beta_.size());
    if (used == basis_.cols()) basis_.conservativeResize(Eigen::NoChange, used + 16);
    basis_.col(used) = next_ / beta;
  }

  SmallSolver ritz_pairs(int steps) const {
    SmallSolver solver;
    solver.computeFromTridiagonal(Eigen::Map<const Eigen::VectorXd>(alpha_.data(), steps),
                                  Eigen::Map<const Eigen::VectorXd>(beta_.data(), steps - 1));
    return solver;
  }

  FiedlerPairs pairs(const SmallSolver& ritz, int steps, int count) const {
    FiedlerPairs result;
    result.lambda.resize(count);
    result.z.resize(basis_.rows(), count);
    for (int k = 0; k < count; ++k) {
      result.lambda[k] = 1 / ritz.eigenvalues()[steps - 1 - k] - kLanczosShift;
      result.z.col(k) = basis_.leftCols(steps) * ritz.eigenvectors().col(steps - 1 - k);
      result.z.col(k).normalize();
    }
    return result;
  }

  LaplacianFactor& factor_;
  Eigen::VectorXd null_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd next_;
  std::vector<double> alpha_;
  std::vector<double> beta_;
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
  return Lanczos(graph, factor).run(count);
}

FiedlerPairs fiedler_pairs(const CsrGraph& graph, int count) {
  FiedlerPairs result;
  if (graph.size() <= kAllPairsSize)
    result = all_pairs(graph, count);
  else if (const auto factor = factorize_laplacian(graph, kLanczosShift))
    result = lanczos_pairs(graph, *factor, count);
  else
    result = multilevel_fiedler(graph);
  fix_signs(result.z);
  set_residual(graph, result);
  return result;
}

}  // namespace hmt::graph
