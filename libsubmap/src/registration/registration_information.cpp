// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "registration_information.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace hmt::submap {
namespace {

// A point meets the surface within so many standard deviations, or within what real walls deviate
// from the straight.
constexpr double kInlierDeviations = 3;
constexpr double kInlierDistance_m = 0.05;
// A direction counts as measured by what the normals show beyond so many of their own standard
// deviations: errors that two scans share from the same laser (steps of range, beams at the same
// bearings) look like structure that moves along with the robot.
constexpr double kChanceDeviations = 2;
constexpr double kLargestVariance = 0.2;
// Lasers err systematically by some millimetres (steps of range, reflectance, angle of incidence),
// by the same amount on all beams that meet a wall, so no number of beams takes it away. A step of
// a centimetre alone leaves 2.9 mm.
constexpr double kSharedError_m = 0.003;

struct InlierSums {
  Matrix6d information = Matrix6d::Zero();
  double chi2 = 0;
  double inflation = 0;  // sum over inliers of (s2 + m t2) / (s2 + t2)
  double range2 = 0;
  int count = 0;
};

// What the matches tell, and what the chance errors of the normals' directions add to it: a
// measured normal cos(e) n + sin(e) t has E[n n^T] = (1 - v) n n^T + v t t^T, v = E[e^2]. With M
// the map from the tangent to the motion of the point, J = M^T n, and I - n n^T for t t^T (over
// both tangents in space), a match is worth (1 + v) J J^T - v M^T M; the second terms add up in the
// moments of the points.
class BiasedSum {
 public:
  void add(double weight, const Vector6d& J, const Eigen::Vector3d& p, double direction_variance) {
    const double v =
        std::min(kChanceDeviations * kChanceDeviations * direction_variance, kLargestVariance);
    outer_.noalias() += (weight * (1 + v)) * J * J.transpose();
    weight_ += weight * v;
    first_ += weight * v * p;
    second_ += weight * v * p * p.transpose();
  }
  const Matrix6d& outer() const { return outer_; }
  Matrix6d chance() const {
    Matrix6d moments;
    const Eigen::Matrix3d cross = graph::skew(first_);
    moments << weight_ * Eigen::Matrix3d::Identity(), -cross, cross,
        second_.trace() * Eigen::Matrix3d::Identity() - second_;
    return moments;
  }

 private:
  Matrix6d outer_ = Matrix6d::Zero();
  double weight_ = 0;
  Eigen::Vector3d first_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second_ = Eigen::Matrix3d::Zero();
};

// A - B without what is negative of it, in the directions in which A is a multiple of B: what no
// surface fixes shows in A by nothing but a share of B, so that exactly this direction is left
// free. The eigenvectors of A - B would be tilted against it, and a pose that is wrong along a
// corridor would be told to be wrong across it.
template <int N>
Eigen::Matrix<double, N, N> beyond(const Eigen::Matrix<double, N, N>& A,
                                   const Eigen::Matrix<double, N, N>& B) {
  constexpr double kRelative = 1e-6, kAbsolute = 1e-9;
  using Square = Eigen::Matrix<double, N, N>;
  Square positive = B;
  positive.diagonal().array() += kRelative * A.diagonal().array() + kAbsolute;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Square> eigen(A, positive);
  const Square outward = positive * eigen.eigenvectors();
  const Square kept = outward * (eigen.eigenvalues().array() - 1).max(0).matrix().asDiagonal() *
                      outward.transpose();
  return (kept + kept.transpose()) / 2;
}

Matrix6d beyond_chance(Space space, const BiasedSum& sum) {
  if (space == Space::se3) return beyond<6>(sum.outer(), sum.chance());
  const Eigen::Array3i plane(0, 1, 5);
  Matrix6d information = Matrix6d::Zero();
  information(plane, plane) = beyond<3>(sum.outer()(plane, plane), sum.chance()(plane, plane));
  return information;
}

std::vector<int> shared_elements(const std::vector<Match>& matches) {
  uint32_t largest = 0;
  for (const Match& match : matches) largest = std::max(largest, match.element);
  std::vector<int> count(largest + 1, 0);
  for (const Match& match : matches) ++count[match.element];
  return count;
}

InlierSums sum_inliers(const SurfaceMatcher& matcher, Space space) {
  InlierSums sums;
  BiasedSum information;
  const std::vector<int> sharing = shared_elements(matcher.matches());
  for (const Match& match : matcher.matches()) {
    if (std::abs(match.residual_m) > match.scale_m) continue;
    const Eigen::Vector3d& p = matcher.source().points_robot[match.source];
    const double independent =
        match.source_variance + sharing[match.element] * match.target_variance;
    information.add(1 / independent, match.jacobian, p, match.normal_variance);
    sums.chi2 += match.residual_m * match.residual_m / match.variance();
    sums.inflation += independent / match.variance();
    sums.range2 += p.squaredNorm();
    ++sums.count;
  }
  sums.information = beyond_chance(space, information);
  return sums;
}

// Variance of a mean of correlated residuals over that of as many independent ones: 1 + 2 sum_k
// rho_k, lags up to the first at which the correlation is lost in its own noise.
double correlation_inflation(const SurfaceMatcher& matcher) {
  std::vector<double> whitened;
  for (const Match& match : matcher.matches())
    if (std::abs(match.residual_m) <= match.scale_m)
      whitened.push_back(match.residual_m / std::sqrt(match.variance()));
  double power = 0;
  for (const double r : whitened) power += r * r;
  if (power <= 0) return 1;
  const double lost = 1 / std::sqrt(static_cast<double>(whitened.size()));
  double inflation = 1;
  for (size_t lag = 1; lag < whitened.size() / 4; ++lag) {
    double product = 0;
    for (size_t i = lag; i < whitened.size(); ++i) product += whitened[i] * whitened[i - lag];
    if (product / power < lost) break;
    inflation += 2 * product / power;
  }
  return inflation;
}

// (I^-1 + B)^-1 for a diagonal B, also where I is singular.
Matrix6d with_shared_error(const Matrix6d& information, double range_m) {
  Vector6d shared;
  shared << Eigen::Vector3d::Constant(kSharedError_m),
      Eigen::Vector3d::Constant(kSharedError_m / range_m);
  const Matrix6d scaled = shared.asDiagonal() * information * shared.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen((scaled + scaled.transpose()) / 2);
  const Vector6d kept =
      eigen.eigenvalues().unaryExpr([](double l) { return l > 0 ? l / (1 + l) : 0.0; });
  const Matrix6d limited =
      eigen.eigenvectors() * kept.asDiagonal() * eigen.eigenvectors().transpose();
  const Vector6d inverse = shared.cwiseInverse();
  const Matrix6d rounded = inverse.asDiagonal() * limited * inverse.asDiagonal();
  return (rounded + rounded.transpose()) / 2;
}

}  // namespace

Matrix6d geometric_information(const SurfaceMatcher& matcher, Space space) {
  const InlierSums sums = sum_inliers(matcher, space);
  if (sums.count == 0) return Matrix6d::Zero();
  return with_shared_error(sums.information, std::sqrt(sums.range2 / sums.count));
}

Matrix6d honest_information(const SurfaceMatcher& matcher, Space space) {
  const InlierSums sums = sum_inliers(matcher, space);
  const int unknowns = space == Space::se2 ? 3 : 6;
  if (sums.count <= unknowns) return Matrix6d::Zero();
  const double variance_factor =
      sums.chi2 / (sums.count - unknowns) * correlation_inflation(matcher);
  const double accounted = sums.inflation / sums.count;
  return with_shared_error(sums.information / std::max(1.0, variance_factor / accounted),
                           std::sqrt(sums.range2 / sums.count));
}

void summarize(const SurfaceMatcher& matcher, Space space, Registration& result) {
  double residual2 = 0;
  for (const Match& match : matcher.matches())
    if (std::abs(match.residual_m) <=
        std::max(kInlierDistance_m, kInlierDeviations * std::sqrt(match.variance()))) {
      ++result.inliers;
      residual2 += match.residual_m * match.residual_m;
    }
  if (result.inliers == 0) return;
  result.inlier_fraction = result.inliers / static_cast<double>(matcher.usable());
  result.rmse_m = std::sqrt(residual2 / result.inliers);
  result.information = honest_information(matcher, space);
}

}  // namespace hmt::submap
