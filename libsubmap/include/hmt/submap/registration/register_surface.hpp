// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "hmt/submap/registration/surface.hpp"

namespace hmt::submap {

/// Surfaces placed in one target frame, with a nearest-neighbor search. Immutable once built; safe
/// to share between threads.
class RegistrationTarget {
 public:
  struct Placed {
    Pose T_target_robot;
    const Surface* surface = nullptr;  ///< copied from; need not outlive the target
  };
  explicit RegistrationTarget(std::span<const Placed> surfaces);
  ~RegistrationTarget();
  RegistrationTarget(RegistrationTarget&&) noexcept;
  RegistrationTarget& operator=(RegistrationTarget&&) noexcept;

  size_t size() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

struct RegistrationOptions {
  Space space = Space::se2;
  /// First radius of the search for corresponding points, metres; shrinks with the residuals. Raise
  /// it for worse guesses.
  double max_correspondence_m = 0.5;
  int max_iterations = 40;
};

/// Result of a registration.
struct Registration {
  enum class Termination { converged, iteration_limit, too_few_points };
  Termination termination = Termination::too_few_points;
  Pose T_target_source;
  /// Inverse covariance of T_target_source (tangent of Pose, frame source), from the normals and
  /// the residuals at the result; rows of directions that the geometry does not fix are (near)
  /// zero.
  Matrix6d information = Matrix6d::Zero();
  /// Share of the source's points with a corresponding surface at the result, in [0, 1].
  double inlier_fraction = 0;
  /// Root mean square distance of the corresponding points along the normals, metres.
  double rmse_m = 0;
  int inliers = 0;
};

/// Robust point-to-surface registration of a source onto a target from a guess.
Registration register_surface(const Surface& source, const RegistrationTarget& target,
                              const Pose& T_target_source_guess,
                              const RegistrationOptions& options);

}  // namespace hmt::submap
