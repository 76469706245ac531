// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "chordal_relaxation.hpp"

#include <Eigen/CholmodSupport>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "elimination_order.hpp"
#include "openmp_guard.hpp"
#include "pose_problem.hpp"

namespace hmt::graph {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// X of H X = B, H by its lower triangle in a good order of elimination; nothing where H is not
/// positive definite.
std::optional<Eigen::MatrixXd> solve_positive_definite(const Triplets& lower,
                                                       const Eigen::MatrixXd& B) {
  SparseMatrix H(B.rows(), B.rows());
  H.setFromTriplets(lower.begin(), lower.end());
  const OpenMpGuard guard;
  Eigen::CholmodDecomposition<SparseMatrix, Eigen::Lower> cholesky;
  cholesky.cholmod().print = 0;
  cholesky.cholmod().nmethods = 1;
  cholesky.cholmod().method[0].ordering = CHOLMOD_NATURAL;
  cholesky.compute(H);
  if (cholesky.info() != Eigen::Success) return std::nullopt;
  Eigen::MatrixXd X = cholesky.solve(B);
  if (!X.allFinite()) return std::nullopt;
  return X;
}

/// The rotations of dimension d: in the plane the upper left block.
template <int d>
Eigen::Matrix<double, d, d> rotation_block(const Pose& pose) {
  return pose.rotation_matrix().topLeftCorner<d, d>();
}

Eigen::Quaterniond nearest_rotation(const Eigen::Matrix2d& M) {
  const double yaw = std::atan2(M(1, 0) - M(0, 1), M(0, 0) + M(1, 1));
  return Pose::planar(0, 0, yaw).rotation;
}

/// The quaternion of the rotation R with the largest trace of M^T R [Horn 1987, Sec. 4]; unlike the
/// polar decomposition it is a rotation for a reflection, too.
Eigen::Quaterniond nearest_rotation(const Eigen::Matrix3d& M) {
  Eigen::Matrix4d N;
  N(0, 0) = M.trace();
  N.block<3, 1>(1, 0) << M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1);
  N.bottomRightCorner<3, 3>() = M + M.transpose();
  N.bottomRightCorner<3, 3>().diagonal().array() -= M.trace();
  // The solver reads the lower triangle.
  const Eigen::Vector4d q = Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(N).eigenvectors().col(3);
  return {q[0], q[1], q[2], q[3]};
}

/// Rows of the unknown matrices are independent and share one system: with x_i a row of R_i, the
/// error of an edge is x_j - R_ij^T x_i.
template <int d>
bool relax_rotations(const PoseGraph& graph, const std::vector<int>& unknown,
                     std::vector<Pose>& poses) {
  using Block = Eigen::Matrix<double, d, d>;
  const auto count = std::count_if(unknown.begin(), unknown.end(), [](int u) { return u >= 0; });
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(d * count, d);
  Triplets H;
  H.reserve(graph.edges.size() * (d * d + 2 * d));
  for (const PoseGraphEdge& edge : graph.edges) {
    const double kappa = edge.information.diagonal().template tail<2 * d - 3>().mean();
    const Block M = kappa * rotation_block<d>(edge.T_from_to);
    const int i = unknown[static_cast<size_t>(edge.from)];
    const int j = unknown[static_cast<size_t>(edge.to)];
    for (const int node : {i, j})
      for (int r = 0; node >= 0 && r < d; ++r) H.emplace_back(d * node + r, d * node + r, kappa);
    const auto known = [&](int node) -> Block {
      return rotation_block<d>(poses[static_cast<size_t>(node)]).transpose();
    };
    if (i >= 0 && j < 0) B.middleRows<d>(d * i) += M * known(edge.to);
    if (j >= 0 && i < 0) B.middleRows<d>(d * j) += M.transpose() * known(edge.from);
    if (i < 0 || j < 0) continue;
    for (int r = 0; r < d; ++r)
      for (int c = 0; c < d; ++c)
        H.emplace_back(std::max(d * i + r, d * j + c), std::min(d * i + r, d * j + c), -M(r, c));
  }
  const auto X = solve_positive_definite(H, B);
  if (!X) return false;
  for (size_t node = 0; node < poses.size(); ++node)
    if (unknown[node] >= 0)
      poses[node].rotation =
          nearest_rotation(Block(X->middleRows<d>(d * unknown[node]).transpose()));
  return true;
}

template <int d>
bool solve_translations(const PoseGraph& graph, const std::vector<int>& unknown,
                        std::vector<Pose>& poses) {
  const auto count = std::count_if(unknown.begin(), unknown.end(), [](int u) { return u >= 0; });
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(count, 3);
  Triplets H;
  H.reserve(graph.edges.size() * 3);
  for (const PoseGraphEdge& edge : graph.edges) {
    const double tau = edge.information.diagonal().template head<d>().mean();
    const Pose& from = poses[static_cast<size_t>(edge.from)];
    const Pose& to = poses[static_cast<size_t>(edge.to)];
    const Eigen::Vector3d step = from.rotation * edge.T_from_to.translation;
    const int i = unknown[static_cast<size_t>(edge.from)];
    const int j = unknown[static_cast<size_t>(edge.to)];
    if (i >= 0) {
      H.emplace_back(i, i, tau);
      B.row(i) += tau * (j < 0 ? Eigen::Vector3d(to.translation - step) : Eigen::Vector3d(-step));
    }
    if (j >= 0) {
      H.emplace_back(j, j, tau);
      B.row(j) += tau * (i < 0 ? Eigen::Vector3d(from.translation + step) : step);
    }
    if (i >= 0 && j >= 0) H.emplace_back(std::max(i, j), std::min(i, j), -tau);
  }
  const auto X = solve_positive_definite(H, B);
  if (!X) return false;
  for (size_t node = 0; node < poses.size(); ++node)
    if (unknown[node] >= 0) poses[node].translation = X->row(unknown[node]);
  return true;
}

template <int d>
std::optional<std::vector<Pose>> relax(const PoseGraph& graph) {
  const std::vector<int> unknown = elimination_order(graph, held_nodes(graph));
  std::vector<Pose> poses = graph.poses;
  // CHOLMOD does not take an empty system.
  if (std::all_of(unknown.begin(), unknown.end(), [](int u) { return u < 0; })) return poses;
  if (!relax_rotations<d>(graph, unknown, poses)) return std::nullopt;
  if (!solve_translations<d>(graph, unknown, poses)) return std::nullopt;
  return poses;
}

}  // namespace

std::optional<std::vector<Pose>> chordal_poses(const PoseGraph& graph) {
  return graph.space == Space::se2 ? relax<2>(graph) : relax<3>(graph);
}

}  // namespace hmt::graph
