// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "hmt/submap/registration/register_surface.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "registration_information.hpp"
#include "registration_target.hpp"
#include "surface_matches.hpp"

namespace hmt::submap {
namespace {

// Steps below this change nothing that a range sensor could tell.
constexpr double kSmallStep_m = 2e-6;
constexpr double kSmallStep_rad = 1e-6;
// Holds the directions that neither surfaces nor prior fix: worth 1 m and 1 rad.
constexpr double kWeakHold = 1.0;

// Gauss-Newton step in the tangent of the pose, frame source.
Vector6d solve_step(const std::vector<Match>& matches, double scale_m, const Pose& T_target_source,
                    const RegistrationOptions& options) {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  for (const Match& match : matches) {
    const double weight = robust_weight(match.residual_m, scale_m) / match.variance();
    H.noalias() += weight * match.jacobian * match.jacobian.transpose();
    g.noalias() -= weight * match.residual_m * match.jacobian;
  }
  if (options.prior) {
    const Vector6d to_prior = boxminus(options.prior->T_target_source, T_target_source);
    H += options.prior->information;
    g += options.prior->information * to_prior;
  }
  H.diagonal().array() += kWeakHold;
  Vector6d step = Vector6d::Zero();
  if (options.space == Space::se2) {
    const Eigen::Array3i plane(0, 1, 5);
    const Eigen::Matrix3d H_plane = H(plane, plane);
    const Eigen::Vector3d g_plane = g(plane);
    step(plane) = H_plane.ldlt().solve(g_plane);
  } else {
    step = H.ldlt().solve(g);
  }
  // The chart of rotations ends at 2; no step needs to be that large.
  const double angle = step.tail<3>().norm();
  return angle > 0.5 ? Vector6d(step * (0.5 / angle)) : step;
}

bool is_small(const Vector6d& step) {
  return step.head<3>().norm() < kSmallStep_m && step.tail<3>().norm() < kSmallStep_rad;
}

}  // namespace

Registration register_surface(const Surface& source, const RegistrationTarget& target,
                              const Pose& T_target_source_guess,
                              const RegistrationOptions& options) {
  Registration result;
  result.T_target_source = T_target_source_guess;
  SurfaceMatcher matcher(source, target.impl(), options.max_correspondence_m);
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    const std::vector<Match>& matches = matcher.match(result.T_target_source);
    if (matches.size() < 3) return result;
    const Vector6d step = solve_step(matches, matcher.scale_m(), result.T_target_source, options);
    result.T_target_source = boxplus(result.T_target_source, step);
    result.termination = Registration::Termination::iteration_limit;
    if (is_small(step) && !matcher.shrunk()) {
      result.termination = Registration::Termination::converged;
      break;
    }
  }
  summarize(matcher, options.space, result);
  return result;
}

}  // namespace hmt::submap
