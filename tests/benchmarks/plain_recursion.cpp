// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "plain_recursion.hpp"

#include <Spectra/SymEigsSolver.h>

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace hmt::benchmarks {
namespace {

using Matrix = Eigen::SparseMatrix<double>;

class ShiftInvert {
 public:
  using Scalar = double;

  explicit ShiftInvert(const Matrix& omega) {
    const auto n = static_cast<int>(omega.rows());
    roots = (omega * Eigen::VectorXd::Ones(n)).cwiseSqrt();
    null_ = roots.normalized();
    const Eigen::VectorXd inverse = roots.cwiseInverse();
    Matrix laplacian = -(inverse.asDiagonal() * omega * inverse.asDiagonal());
    Matrix identity(n, n);
    identity.setIdentity();
    laplacian += (1 + 1e-7) * identity;
    factor_.compute(laplacian);
  }
  Eigen::Index rows() const { return roots.size(); }
  Eigen::Index cols() const { return roots.size(); }
  void perform_op(const double* in, double* out) const {
    const Eigen::Map<const Eigen::VectorXd> b(in, rows());
    Eigen::VectorXd x = factor_.solve(b - null_ * null_.dot(b));
    Eigen::Map<Eigen::VectorXd>(out, rows()) = x - null_ * null_.dot(x);
  }

  Eigen::VectorXd roots;

 private:
  Eigen::VectorXd null_;
  Eigen::CholmodDecomposition<Matrix> factor_;
};

Eigen::VectorXd fiedler_vector(const Matrix& omega) {
  ShiftInvert inverse(omega);
  const auto n = static_cast<int>(inverse.rows());
  Spectra::SymEigsSolver<ShiftInvert> solver(inverse, 1, std::min(n, 20));
  Eigen::VectorXd start(n);
  std::minstd_rand random(1);
  for (double& x : start) x = static_cast<double>(random()) / std::minstd_rand::max() - 0.5;
  solver.init(start.data());
  solver.compute(Spectra::SortRule::LargestAlge, 1000, 1e-8);
  return solver.eigenvectors().col(0).cwiseQuotient(inverse.roots);
}

// Order along the vector, nodes before the best threshold, and its Ncut.
struct Cut {
  std::vector<int> order;
  int below = 0;
  double ncut = std::numeric_limits<double>::infinity();
};

Cut sweep(const Matrix& omega) {
  const Eigen::VectorXd y = fiedler_vector(omega);
  const Eigen::VectorXd degrees = omega * Eigen::VectorXd::Ones(omega.rows());
  Cut best;
  best.order.resize(static_cast<size_t>(y.size()));
  std::iota(best.order.begin(), best.order.end(), 0);
  std::sort(best.order.begin(), best.order.end(), [&](int a, int b) { return y[a] < y[b]; });
  std::vector<char> moved(best.order.size(), 0);
  const double total = degrees.sum();
  double cut = 0;
  double assoc = 0;
  for (size_t k = 0; k + 1 < best.order.size(); ++k) {
    const int i = best.order[k];
    cut += degrees[i];
    for (Matrix::InnerIterator it(omega, i); it; ++it)
      if (moved[static_cast<size_t>(it.row())] != 0) cut -= 2 * it.value();
    assoc += degrees[i];
    moved[static_cast<size_t>(i)] = 1;
    const double ncut = cut / assoc + cut / (total - assoc);
    if (ncut >= best.ncut) continue;
    best.ncut = ncut;
    best.below = static_cast<int>(k) + 1;
  }
  return best;
}

Matrix part(const Matrix& omega, const std::vector<int>& nodes) {
  std::vector<int> local(static_cast<size_t>(omega.rows()), -1);
  for (size_t i = 0; i < nodes.size(); ++i)
    local[static_cast<size_t>(nodes[i])] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (const int node : nodes)
    for (Matrix::InnerIterator it(omega, node); it; ++it)
      if (const int row = local[static_cast<size_t>(it.row())]; row >= 0)
        entries.emplace_back(row, local[static_cast<size_t>(node)], it.value());
  Matrix result(static_cast<int>(nodes.size()), static_cast<int>(nodes.size()));
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void recurse(const Matrix& omega, double tau, PlainResult& result) {
  if (omega.rows() >= 3) {
    const Cut cut = sweep(omega);
    if (result.top_ncut == 0) result.top_ncut = cut.ncut;
    if (cut.ncut < tau) {
      recurse(part(omega, {cut.order.begin(), cut.order.begin() + cut.below}), tau, result);
      recurse(part(omega, {cut.order.begin() + cut.below, cut.order.end()}), tau, result);
      return;
    }
  }
  ++result.groups;
}

}  // namespace

PlainResult plain_recursion(const graph::WeightedGraph& graph, double tau) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const graph::Arc& arc : graph.arcs()) {
    entries.emplace_back(arc.a, arc.b, arc.weight);
    entries.emplace_back(arc.b, arc.a, arc.weight);
  }
  Matrix omega(graph.num_nodes(), graph.num_nodes());
  omega.setFromTriplets(entries.begin(), entries.end());
  PlainResult result;
  recurse(omega, tau, result);
  return result;
}

}  // namespace hmt::benchmarks
