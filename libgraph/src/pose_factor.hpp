// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "hmt/graph/pose_graph.hpp"

// The measurement model of a pose graph, written once for the plane and for space: what differs
// between them is a chart (the numbers that stand for a pose) and the error with its derivatives.
namespace hmt::graph {

/// Pose in the plane as (x, y, yaw); a step is added.
struct PlanarChart {
  static constexpr int kParameters = 3;
  static constexpr int kTangent = 3;
  static constexpr int kPoint = 2;  ///< numbers of a point
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

  /// T_from_to as measured.
  struct Measurement {
    explicit Measurement(const Pose& T_from_to);
    Eigen::Matrix2d R_transposed;
    Eigen::Vector2d translation;
    double yaw_rad;
  };

  static void store(const Pose& T_world_node, double* parameters);
  static Pose load(const double* parameters);
  static Vector error(const Measurement& measured, const double* from, const double* to);
  static Vector linearize(const Measurement& measured, const double* from, const double* to,
                          Matrix& J_from, Matrix& J_to);

  using PointVector = Eigen::Vector2d;
  using PointMatrix = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;
  using PointByPose = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
  /// The point in the frame of the node, with its derivatives by the steps of both.
  static PointVector linearize_point(const double* node, const double* point, PointByPose& J_node,
                                     PointMatrix& J_point);
};

/// Pose in space as (x, y, z, qx, qy, qz, qw). A step (dx, dy, dz, rx, ry, rz) adds to the position
/// and turns the rotation from the right by 2 vec(q) = (rx, ry, rz).
struct SpatialChart {
  static constexpr int kParameters = 7;
  static constexpr int kTangent = 6;
  static constexpr int kPoint = 3;
  using Vector = Vector6d;
  using Matrix = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

  /// T_from_to as measured.
  struct Measurement {
    explicit Measurement(const Pose& T_from_to);
    Eigen::Matrix3d R_transposed;
    Eigen::Vector3d translation;
    Eigen::Quaterniond q_inverse;
  };

  static void store(const Pose& T_world_node, double* parameters);
  static Pose load(const double* parameters);
  static Vector error(const Measurement& measured, const double* from, const double* to);
  static Vector linearize(const Measurement& measured, const double* from, const double* to,
                          Matrix& J_from, Matrix& J_to);

  using PointVector = Eigen::Vector3d;
  using PointMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  using PointByPose = Eigen::Matrix<double, 3, 6, Eigen::RowMajor>;
  /// The point in the frame of the node, with its derivatives by the steps of both.
  static PointVector linearize_point(const double* node, const double* point, PointByPose& J_node,
                                     PointMatrix& J_point);
};

/// One edge of a pose graph, ready to be evaluated many times.
///
/// Error in the tangent of the chart (plane: x, y, rz; space: x, y, z, rx, ry, rz), with
/// T_z = T_from_to as measured: r = (R_z^T (R_from^T (t_to - t_from) - t_z), wrap(yaw)) or
/// (..., 2 vec(q_z^-1 q_from^-1 q_to)) with q_w >= 0.
template <class Chart>
class EdgeFactor {
 public:
  using Vector = typename Chart::Vector;
  using Matrix = typename Chart::Matrix;
  using ByPose = Matrix;

  /// The information must be positive semidefinite up to rounding.
  explicit EdgeFactor(const PoseGraphEdge& edge);

  /// Whitened error W r with W^T W = information.
  Vector error(const double* from, const double* to) const {
    return whitening_ * Chart::error(measured_, from, to);
  }
  /// The same with its derivatives by the steps of the two poses.
  Vector linearize(const double* from, const double* to, Matrix& J_from, Matrix& J_to) const {
    Matrix J_f, J_t;
    const Vector r = Chart::linearize(measured_, from, to, J_f, J_t);
    J_from.noalias() = whitening_ * J_f;
    J_to.noalias() = whitening_ * J_t;
    return whitening_ * r;
  }
  /// r^T information r.
  double chi2(const double* from, const double* to) const { return error(from, to).squaredNorm(); }

 private:
  typename Chart::Measurement measured_;
  Matrix whitening_;
};

/// One measured point, ready to be evaluated many times: r = R_node^T (p - t_node) - p_node.
template <class Chart>
class PointFactor {
 public:
  using Vector = typename Chart::PointVector;
  using Matrix = typename Chart::PointMatrix;
  using ByPose = typename Chart::PointByPose;

  /// The information must be positive semidefinite up to rounding.
  explicit PointFactor(const PointEdge& edge);

  /// Whitened error W r with W^T W = information, and its derivatives by the steps of both.
  Vector linearize(const double* node, const double* point, ByPose& J_node, Matrix& J_point) const {
    ByPose J_n;
    Matrix J_p;
    const Vector local = Chart::linearize_point(node, point, J_n, J_p);
    J_node.noalias() = whitening_ * J_n;
    J_point.noalias() = whitening_ * J_p;
    return whitening_ * (local - measured_);
  }
  Vector error(const double* node, const double* point) const {
    ByPose J_node;
    Matrix J_point;
    return whitening_ * (Chart::linearize_point(node, point, J_node, J_point) - measured_);
  }
  /// r^T information r.
  double chi2(const double* node, const double* point) const {
    return error(node, point).squaredNorm();
  }

 private:
  Vector measured_;
  Matrix whitening_;
};

/// The part of a tangent matrix of Pose that the chart uses: rows and columns x, y, rz in the
/// plane.
template <class Chart>
Eigen::Matrix<double, Chart::kTangent, Chart::kTangent> chart_block(const Matrix6d& matrix);
/// The inverse of chart_block; zero elsewhere.
template <class Chart>
Matrix6d from_chart_block(const Eigen::Matrix<double, Chart::kTangent, Chart::kTangent>& block);

/// The part of a tangent vector of Pose that the chart uses.
template <class Chart>
typename Chart::Vector chart_vector(const Vector6d& vector);

extern template class EdgeFactor<PlanarChart>;
extern template class EdgeFactor<SpatialChart>;
extern template class PointFactor<PlanarChart>;
extern template class PointFactor<SpatialChart>;

/// Whether a symmetric matrix is positive definite, by its Cholesky factor.
template <class Matrix>
bool is_definite(const Matrix& matrix) {
  return Eigen::LLT<Matrix>(matrix).info() == Eigen::Success;
}

/// Whether no eigenvalue is negative beyond rounding: 1e-9 of the largest.
template <class Matrix>
bool is_semidefinite(const Matrix& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(matrix, Eigen::EigenvaluesOnly);
  const auto& values = eigen.eigenvalues();
  return values[0] >= -1e-9 * std::max(0.0, values[values.size() - 1]);
}

/// Calls `function` with the chart of the space, as `function(PlanarChart{})`.
template <class Function>
auto with_chart(Space space, Function&& function) {
  return space == Space::se2 ? function(PlanarChart{}) : function(SpatialChart{});
}

}  // namespace hmt::graph
