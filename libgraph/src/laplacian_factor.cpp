// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "laplacian_factor.hpp"

#include <suitesparse/cholmod.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "openmp_guard.hpp"

namespace hmt::graph {
namespace {

// Below this size a dense factor beats the overhead of a sparse one.
constexpr int kDenseSize = 160;

Eigen::VectorXd inverse_roots(const CsrGraph& graph) {
  Eigen::VectorXd roots(graph.size());
  for (int i = 0; i < graph.size(); ++i)
    roots[i] = 1 / std::sqrt(graph.degrees[static_cast<size_t>(i)]);
  return roots;
}

class DenseFactor : public LaplacianFactor {
 public:
  DenseFactor(const CsrGraph& graph, double shift) {
    const Eigen::VectorXd roots = inverse_roots(graph);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(graph.size(), graph.size());
    for (int i = 0; i < graph.size(); ++i) {
      matrix(i, i) = 1 + shift;
      for (auto k = static_cast<size_t>(graph.offsets[static_cast<size_t>(i)]);
           k < static_cast<size_t>(graph.offsets[static_cast<size_t>(i) + 1]); ++k)
        matrix(graph.columns[k], i) -= graph.weights[k] * roots[i] * roots[graph.columns[k]];
    }
    factor_.compute(matrix);
  }
  bool ok() const { return factor_.info() == Eigen::Success; }
  void solve(Eigen::Ref<const Eigen::VectorXd> b, Eigen::VectorXd& x) override {
    x = b;
    factor_.solveInPlace(x);
  }

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

class SparseFactor : public LaplacianFactor {
 public:
  SparseFactor(const CsrGraph& graph, double shift, const FactorLimits& limits) {
    cholmod_start(&common_);
    common_.print = 0;
    common_.error_handler = nullptr;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_AMD;
    const OpenMpGuard serial;
    cholmod_sparse* matrix = lower_triangle(graph, shift);
    if (matrix == nullptr) return;
    factor_ = cholmod_analyze(matrix, &common_);
    const bool fits = factor_ != nullptr && common_.fl <= limits.flops &&
                      common_.lnz * static_cast<double>(sizeof(double)) <= limits.bytes;
    ok_ = fits && cholmod_factorize(matrix, factor_, &common_) != 0 &&
          common_.status == CHOLMOD_OK && factor_->minor == factor_->n;
    cholmod_free_sparse(&matrix, &common_);
  }
  ~SparseFactor() override {
    cholmod_free_dense(&solution_, &common_);
    cholmod_free_dense(&work_y_, &common_);
    cholmod_free_dense(&work_e_, &common_);
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  SparseFactor(const SparseFactor&) = delete;
  SparseFactor& operator=(const SparseFactor&) = delete;

  bool ok() const { return ok_; }

  void solve(Eigen::Ref<const Eigen::VectorXd> b, Eigen::VectorXd& x) override {
    cholmod_dense rhs = {};
    rhs.nrow = rhs.d = rhs.nzmax = static_cast<size_t>(b.size());
    rhs.ncol = 1;
    rhs.x = const_cast<double*>(b.data());  // CHOLMOD only reads it
    rhs.xtype = CHOLMOD_REAL;
    rhs.dtype = CHOLMOD_DOUBLE;
    if (cholmod_solve2(CHOLMOD_A, factor_, &rhs, nullptr, &solution_, nullptr, &work_y_, &work_e_,
                       &common_) == 0)
      throw std::bad_alloc();
    x = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(solution_->x), b.size());
  }

 private:
  cholmod_sparse* lower_triangle(const CsrGraph& graph, double shift) {
    const auto n = static_cast<size_t>(graph.size());
    const size_t entries = (graph.columns.size() + n) / 2 + n;
    if (entries > static_cast<size_t>(std::numeric_limits<int>::max())) return nullptr;
    cholmod_sparse* matrix =
        cholmod_allocate_sparse(n, n, entries, 1, 1, -1, CHOLMOD_REAL, &common_);
    if (matrix == nullptr) return nullptr;
    const Eigen::VectorXd roots = inverse_roots(graph);
    auto* const starts = static_cast<int*>(matrix->p);
    auto* const rows = static_cast<int*>(matrix->i);
    auto* const values = static_cast<double*>(matrix->x);
    int next = 0;
    for (size_t i = 0; i < n; ++i) {
      starts[i] = next;
      const int diagonal = next++;
      rows[diagonal] = static_cast<int>(i);
      values[diagonal] = 1 + shift;
      for (auto k = static_cast<size_t>(graph.offsets[i]);
           k < static_cast<size_t>(graph.offsets[i + 1]); ++k) {
        const int j = graph.columns[k];
        if (static_cast<size_t>(j) < i) continue;
        const double value = -graph.weights[k] * roots[static_cast<int>(i)] * roots[j];
        if (static_cast<size_t>(j) == i) {
          values[diagonal] += value;
          continue;
        }
        rows[next] = j;
        values[next++] = value;
      }
    }
    starts[n] = next;
    return matrix;
  }

  cholmod_common common_ = {};
  cholmod_factor* factor_ = nullptr;
  cholmod_dense* solution_ = nullptr;
  cholmod_dense* work_y_ = nullptr;
  cholmod_dense* work_e_ = nullptr;
  bool ok_ = false;
};

}  // namespace

std::unique_ptr<LaplacianFactor> factorize_laplacian(const CsrGraph& graph, double shift,
                                                     const FactorLimits& limits) {
  if (graph.size() <= kDenseSize) {
    auto dense = std::make_unique<DenseFactor>(graph, shift);
    if (dense->ok()) return dense;
    return nullptr;
  }
  auto sparse = std::make_unique<SparseFactor>(graph, shift, limits);
  if (sparse->ok()) return sparse;
  return nullptr;
}

void apply_laplacian(const CsrGraph& graph, const Eigen::VectorXd& x, Eigen::VectorXd& y) {
  const Eigen::VectorXd roots = inverse_roots(graph);
  const Eigen::VectorXd scaled = x.cwiseProduct(roots);
  y.resize(x.size());
  for (int i = 0; i < graph.size(); ++i) {
    double sum = 0;
    for (auto k = static_cast<size_t>(graph.offsets[static_cast<size_t>(i)]);
         k < static_cast<size_t>(graph.offsets[static_cast<size_t>(i) + 1]); ++k)
      sum += graph.weights[k] * scaled[graph.columns[k]];
    y[i] = x[i] - roots[i] * sum;
  }
}

}  // namespace hmt::graph
