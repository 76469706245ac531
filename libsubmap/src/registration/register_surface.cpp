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

// Steps below these change nothing that a range sensor could tell ...
constexpr double kSmallStep_m = 5e-6;
constexpr double kSmallStep_rad = 5e-6;
// ... and after so many iterations the result may swing between two sets of matches by so much
// more.
constexpr int kSwingAfter = 12;
constexpr double kSwing = 20;
// Makes singular systems solvable; worth 100 m and 100 rad, so it holds nothing.
constexpr double kNothing = 1e-4;

// Solution of A x = b over the coordinates that the space has.
Vector6d solve_in(Space space, const Matrix6d& A, const Vector6d& b) {
  if (space == Space::se3) return A.ldlt().solve(b);
  const Eigen::Array3i plane(0, 1, 5);
  const Eigen::Matrix3d A_plane = A(plane, plane);
  const Eigen::Vector3d b_plane = b(plane);
  Vector6d x = Vector6d::Zero();
  x(plane) = A_plane.ldlt().solve(b_plane);
  return x;
}

// Step in the tangent of the pose, frame source. The least-squares step u = H^-1 g of the surfaces
// enters as a measurement with the information I that the geometry supports, not with H: noise in
// the normals makes H fix directions that the geometry leaves free, and would hold the pose where
// it is against the prior. With prior information P about the step d to the prior: (I + P) x = I u
// + P d.
Vector6d solve_step(const SurfaceMatcher& matcher, const Pose& T_target_source,
                    const RegistrationOptions& options) {
  Matrix6d H = kNothing * Matrix6d::Identity();
  Vector6d g = Vector6d::Zero();
  for (const Match& match : matcher.matches()) {
    const double weight = robust_weight(match.residual_m, match.scale_m) / match.variance();
    H.noalias() += weight * match.jacobian * match.jacobian.transpose();
    g.noalias() -= weight * match.residual_m * match.jacobian;
  }
  Matrix6d information = geometric_information(matcher, options.space);
  Vector6d weighted = information * solve_in(options.space, H, g);
  if (options.prior) {
    information += options.prior->information;
    weighted +=
        options.prior->information * boxminus(options.prior->T_target_source, T_target_source);
  }
  information += kNothing * Matrix6d::Identity();
  const Vector6d step = solve_in(options.space, information, weighted);
  // The chart of rotations ends at 2; no step needs to be that large.
  const double angle = step.tail<3>().norm();
  return angle > 0.5 ? Vector6d(step * (0.5 / angle)) : step;
}

bool is_small(const Vector6d& step, int iteration) {
  const double share = iteration < kSwingAfter ? 1 : kSwing;
  return step.head<3>().norm() < share * kSmallStep_m &&
         step.tail<3>().norm() < share * kSmallStep_rad;
}

}  // namespace

Registration register_surface(const Surface& source, const RegistrationTarget& target,
                              const Pose& T_target_source_guess,
                              const RegistrationOptions& options) {
  Registration result;
  result.T_target_source = T_target_source_guess;
  SurfaceMatcher matcher(source, target.impl(), options);
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    matcher.match(result.T_target_source);
    if (matcher.matches().size() < 3) return result;
    const Vector6d step = solve_step(matcher, result.T_target_source, options);
    result.T_target_source = boxplus(result.T_target_source, step);
    result.termination = Registration::Termination::iteration_limit;
    if (is_small(step, iteration) && !matcher.shrunk()) {
      result.termination = Registration::Termination::converged;
      break;
    }
  }
  summarize(matcher, options.space, result);
  return result;
}

}  // namespace hmt::submap
