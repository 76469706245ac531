// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "multilevel_fiedler.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "coarsening.hpp"
#include "laplacian_factor.hpp"

namespace hmt::graph {
namespace {

using Eigen::VectorXd;

// Coarsened until the group can be solved in a moment, or hardly shrinks any more.
constexpr int kCoarsestSize = 3000;
constexpr double kLeastShrinkage = 0.8;
// Residual relative to the eigenvalue at which the vector is good enough for a sweep.
constexpr double kTolerance = 1e-4;
constexpr int kMaxSteps = 40;
constexpr double kJacobiWeight = 0.7;
// Piecewise constant interpolation makes smooth vectors too stiff, so their correction too small.
constexpr double kOverCorrection = 1.6;

struct Level {
  const CsrGraph* graph = nullptr;
  const std::vector<int>* aggregate = nullptr;  // to the next coarser level; null at the coarsest
  VectorXd roots;                               // D^{1/2}
  VectorXd null;                                // D^{1/2} 1, normalized
  VectorXd diagonal;                            // of the normalized Laplacian
};

Level make_level(const CsrGraph& graph, const std::vector<int>* aggregate) {
  Level level{&graph, aggregate, {}, {}, {}};
  level.roots = Eigen::Map<const VectorXd>(graph.degrees.data(), graph.size()).cwiseSqrt();
  level.null = level.roots.normalized();
  level.diagonal = VectorXd::Ones(graph.size());
  for (int i = 0; i < graph.size(); ++i)
    for (auto k = static_cast<size_t>(graph.offsets[static_cast<size_t>(i)]);
         k < static_cast<size_t>(graph.offsets[static_cast<size_t>(i) + 1]); ++k)
      if (graph.columns[k] == i)
        level.diagonal[i] -= graph.weights[k] / graph.degrees[static_cast<size_t>(i)];
  return level;
}

void project(const Level& level, VectorXd& x) {
  x -= level.null * level.null.dot(x);
}

// The levels of one group, finest first, and the work on them.
class Multigrid {
 public:
  explicit Multigrid(const CsrGraph& graph) {
    const CsrGraph* finest = &graph;
    while (finest->size() > kCoarsestSize) {
      CoarseGraph next = coarsen(*finest);
      if (next.graph.size() > kLeastShrinkage * finest->size()) break;
      coarse_.push_back(std::make_unique<CoarseGraph>(std::move(next)));
      levels_.push_back(make_level(*finest, &coarse_.back()->aggregate));
      finest = &coarse_.back()->graph;
    }
    levels_.push_back(make_level(*finest, nullptr));
  }

  FiedlerPairs solve() {
    const size_t coarsest = levels_.size() - 1;
    const CsrGraph& graph = *levels_[coarsest].graph;
    factor_ = factorize_laplacian(graph, kLanczosShift);
    VectorXd x = start_vector(graph.size());
    FiedlerPairs pairs;
    if (factor_) pairs = lanczos_pairs(graph, *factor_, 1);
    // A group that cannot be coarsened, such as a star, has to do without preconditioner.
    if (pairs.z.cols() > 0)
      x = pairs.z.col(0);
    else
      improve(coarsest, x);
    for (size_t l = coarsest; l-- > 0;) {
      x = prolongate(l, x);
      improve(l, x);
    }
    return {VectorXd::Zero(1), x, 0};
  }

 private:
  // In the scale z = D^{1/2} y the interpolation has unit columns: sqrt(d_i / d_aggregate).
  VectorXd prolongate(size_t l, const VectorXd& coarse) const {
    const Level& level = levels_[l];
    VectorXd fine(level.graph->size());
    for (int i = 0; i < fine.size(); ++i) {
      const int a = (*level.aggregate)[static_cast<size_t>(i)];
      fine[i] = coarse[a] * level.roots[i] / levels_[l + 1].roots[a];
    }
    return fine;
  }

  VectorXd restrict_to_coarse(size_t l, const VectorXd& fine) const {
    const Level& level = levels_[l];
    VectorXd coarse = VectorXd::Zero(levels_[l + 1].graph->size());
    for (int i = 0; i < fine.size(); ++i) {
      const int a = (*level.aggregate)[static_cast<size_t>(i)];
      coarse[a] += fine[i] * level.roots[i] / levels_[l + 1].roots[a];
    }
    return coarse;
  }

  // One symmetric V cycle for L x = b.
  VectorXd cycle(size_t l, const VectorXd& b) {
    const Level& level = levels_[l];
    VectorXd x;
    if (level.aggregate == nullptr) {
      if (!factor_) return b;
      factor_->solve(b, x);
      project(level, x);
      return x;
    }
    VectorXd product;
    x = kJacobiWeight * b.cwiseQuotient(level.diagonal);
    apply_laplacian(*level.graph, x, product);
    x += kOverCorrection * prolongate(l, cycle(l + 1, restrict_to_coarse(l, b - product)));
    apply_laplacian(*level.graph, x, product);
    x += kJacobiWeight * (b - product).cwiseQuotient(level.diagonal);
    return x;
  }

  // Lowers the Rayleigh quotient of x over the space of x, the preconditioned residual and the last
  // direction, until the residual is small.
  void improve(size_t l, VectorXd& x) {
    const Level& level = levels_[l];
    project(level, x);
    x.normalize();
    VectorXd lx;
    VectorXd direction;
    VectorXd l_direction;
    apply_laplacian(*level.graph, x, lx);
    for (int step = 0; step < kMaxSteps; ++step) {
      const double lambda = x.dot(lx);
      const VectorXd residual = lx - lambda * x;
      if (residual.norm() <= kTolerance * lambda) return;
      VectorXd w = cycle(l, residual);
      project(level, w);
      w -= x * x.dot(w);
      w.normalize();
      VectorXd lw;
      apply_laplacian(*level.graph, w, lw);
      rayleigh_ritz(x, lx, w, lw, direction, l_direction);
    }
  }

  static void rayleigh_ritz(VectorXd& x, VectorXd& lx, VectorXd& w, VectorXd& lw, VectorXd& p,
                            VectorXd& lp) {
    if (p.size() > 0) {
      const double along_x = x.dot(p);
      const double along_w = w.dot(p);
      p -= along_x * x + along_w * w;
      lp -= along_x * lx + along_w * lw;
      const double norm = p.norm();
      if (norm > 1e-10) {
        p /= norm;
        lp /= norm;
      } else {
        p.resize(0);
      }
    }
    const int size = p.size() > 0 ? 3 : 2;
    Eigen::Matrix3d small = Eigen::Matrix3d::Identity() * 4;  // beyond the spectrum
    const VectorXd* basis[] = {&x, &w, &p};
    const VectorXd* images[] = {&lx, &lw, &lp};
    for (int i = 0; i < size; ++i)
      for (int j = 0; j < size; ++j) small(i, j) = basis[i]->dot(*images[j]);
    small = (0.5 * (small + small.transpose())).eval();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(small);
    const Eigen::Vector3d c = solver.eigenvectors().col(0);
    VectorXd next = c[1] * w;
    VectorXd l_next = c[1] * lw;
    if (size == 3) {
      next += c[2] * p;
      l_next += c[2] * lp;
    }
    x = c[0] * x + next;
    lx = c[0] * lx + l_next;
    p = std::move(next);
    lp = std::move(l_next);
  }

  std::vector<std::unique_ptr<CoarseGraph>> coarse_;
  std::vector<Level> levels_;
  std::unique_ptr<LaplacianFactor> factor_;
};

}  // namespace

FiedlerPairs multilevel_fiedler(const CsrGraph& graph) {
  return Multigrid(graph).solve();
}

}  // namespace hmt::graph
