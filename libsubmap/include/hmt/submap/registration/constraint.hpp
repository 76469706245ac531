// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "hmt/submap/observation/observation.hpp"

namespace hmt::submap {

/// Where a constraint comes from.
enum class ConstraintKind {
  odometry,      ///< consecutive keyframes, from the front end
  registration,  ///< two keyframes whose overlap was predicted and confirmed by registration
  loop,          ///< found by the loop search
  confirmed      ///< a loop that the user vouches for
};

/// Measured relative pose of two keyframes, a < b.
struct Constraint {
  int a = 0;
  int b = 0;
  ConstraintKind kind = ConstraintKind::registration;
  Pose T_a_b;
  /// Inverse covariance in the tangent of Pose (frame b); singular where the geometry does not fix
  /// a direction, such as along a corridor. In Space::se2 only x, y and rz are used.
  Matrix6d information = Matrix6d::Zero();

  bool operator==(const Constraint&) const = default;
};

/// Keyframes at most this far apart in number belong to one visit of the robot to a place.
inline constexpr int kVisitGap = 10;

/// True for odometry and for registrations within one visit: the drift between the two keyframes is
/// so small that the registration cannot have gone to a wrong place.
inline bool is_within_visit(const Constraint& c) {
  return (c.kind == ConstraintKind::odometry || c.kind == ConstraintKind::registration) &&
         c.b - c.a <= kVisitGap;
}

/// True for what the robust optimization never doubts.
inline bool is_trusted(const Constraint& c) {
  return is_within_visit(c) || c.kind == ConstraintKind::confirmed;
}

/// Smallest eigenvalue of the information over the directions that the space has: what the least
/// known direction is known to, 1/m^2 or 1/rad^2. Zero where a direction is free.
double firmness(const Constraint& constraint, Space space);

/// True if the constraint alone ties its two keyframes: no direction is left freer than a metre or
/// a radian, beyond which a linearization says nothing.
inline bool is_firm(const Constraint& constraint, Space space) {
  return firmness(constraint, space) >= 1;
}

/// Covariance of T_a_b of two keyframes by what is known of the trajectory (tangent of Pose, frame
/// b); nothing where they are not connected.
using PairCovariance = std::function<std::optional<Matrix6d>(int a, int b)>;

}  // namespace hmt::submap
