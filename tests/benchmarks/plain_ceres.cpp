// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "plain_ceres.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <array>
#include <chrono>
#include <cmath>
#include <vector>

namespace hmt::benchmarks {
namespace {

struct PlanarError {
  Eigen::Vector3d measured;
  Eigen::Matrix3d root;

  template <class T>
  bool operator()(const T* from, const T* to, T* residual) const {
    using std::atan2;
    using std::cos;
    using std::sin;
    const Eigen::Rotation2D<T> R_from(from[2]);
    const Eigen::Rotation2D<T> R_z{T(measured[2])};
    const Eigen::Matrix<T, 2, 1> step(to[0] - from[0], to[1] - from[1]);
    Eigen::Matrix<T, 3, 1> r;
    const T angle = to[2] - from[2] - measured[2];
    r << R_z.inverse() * (R_from.inverse() * step - measured.head<2>().cast<T>()),
        atan2(sin(angle), cos(angle));
    Eigen::Map<Eigen::Matrix<T, 3, 1>>{residual} = root.cast<T>() * r;
    return true;
  }
};

struct SpatialError {
  graph::Pose measured;
  graph::Matrix6d root;

  template <class T>
  bool operator()(const T* t_from, const T* q_from, const T* t_to, const T* q_to,
                  T* residual) const {
    using Quaternion = Eigen::Map<const Eigen::Quaternion<T>>;
    using Vector = Eigen::Map<const Eigen::Matrix<T, 3, 1>>;
    const Eigen::Quaternion<T> back = Quaternion(q_from).conjugate();
    const Eigen::Quaternion<T> q_z = measured.rotation.cast<T>();
    Eigen::Quaternion<T> q = q_z.conjugate() * back * Quaternion(q_to);
    if (q.w() < T(0)) q.coeffs() = -q.coeffs();
    Eigen::Matrix<T, 6, 1> r;
    r << q_z.conjugate() *
             (back * (Vector(t_to) - Vector(t_from)) - measured.translation.cast<T>()),
        T(2) * q.vec();
    Eigen::Map<Eigen::Matrix<T, 6, 1>>{residual} = root.cast<T>() * r;
    return true;
  }
};

std::vector<double> add_planar(const graph::PoseGraph& graph, ceres::Problem& problem) {
  std::vector<double> p;
  for (const graph::Pose& pose : graph.poses)
    p.insert(p.end(), {pose.translation.x(), pose.translation.y(), pose.yaw_rad()});
  for (const graph::PoseGraphEdge& edge : graph.edges) {
    const std::array<int, 3> rows = {0, 1, 5};
    const Eigen::Matrix3d information = edge.information(rows, rows);
    const Eigen::Vector3d measured(edge.T_from_to.translation.x(), edge.T_from_to.translation.y(),
                                   edge.T_from_to.yaw_rad());
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PlanarError, 3, 3, 3>(
                                 new PlanarError{measured, information.llt().matrixU()}),
                             nullptr, &p[3 * static_cast<size_t>(edge.from)],
                             &p[3 * static_cast<size_t>(edge.to)]);
  }
  problem.SetParameterBlockConstant(p.data());
  return p;
}

std::vector<double> add_spatial(const graph::PoseGraph& graph, ceres::Problem& problem) {
  std::vector<double> p;
  for (const graph::Pose& pose : graph.poses) {
    p.insert(p.end(), pose.translation.data(), pose.translation.data() + 3);
    p.insert(p.end(), pose.rotation.coeffs().data(), pose.rotation.coeffs().data() + 4);
  }
  for (const graph::PoseGraphEdge& edge : graph.edges) {
    double* const from = &p[7 * static_cast<size_t>(edge.from)];
    double* const to = &p[7 * static_cast<size_t>(edge.to)];
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<SpatialError, 6, 3, 4, 3, 4>(
            new SpatialError{edge.T_from_to, edge.information.llt().matrixU()}),
        nullptr, from, from + 3, to, to + 3);
  }
  auto* const manifold = new ceres::EigenQuaternionManifold;
  for (size_t k = 0; k < graph.poses.size(); ++k) problem.SetManifold(&p[7 * k + 3], manifold);
  problem.SetParameterBlockConstant(p.data());
  problem.SetParameterBlockConstant(p.data() + 3);
  return p;
}

}  // namespace

PlainCeresResult solve_with_plain_ceres(const graph::PoseGraph& graph) {
  const auto begin = std::chrono::steady_clock::now();
  ceres::Problem problem;
  const std::vector<double> parameters =
      graph.space == graph::Space::se2 ? add_planar(graph, problem) : add_spatial(graph, problem);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  return {2 * summary.final_cost, time.count(), static_cast<int>(summary.iterations.size()) - 1};
}

}  // namespace hmt::benchmarks
