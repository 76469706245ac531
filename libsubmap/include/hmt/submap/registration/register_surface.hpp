// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
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
  /// `cell_m`: side of the cubes whose points of like normals are merged into one, (0, 1].
  explicit RegistrationTarget(std::span<const Placed> surfaces, double cell_m = 0.05);
  ~RegistrationTarget();
  RegistrationTarget(RegistrationTarget&&) noexcept;
  RegistrationTarget& operator=(RegistrationTarget&&) noexcept;

  /// Number of surface elements: points of nearly equal place and normal are merged into one.
  size_t size() const;

  struct Impl;
  const Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// What is known of a pose before the registration.
struct PosePrior {
  Pose T_target_source;
  Matrix6d information = Matrix6d::Zero();  ///< tangent of Pose, frame source; may be singular
};

struct RegistrationOptions {
  Space space = Space::se2;
  /// First radius of the search for corresponding points, metres; shrinks with the residuals. Raise
  /// it for worse guesses.
  double max_correspondence_m = 0.5;
  /// In space: nothing tells how far off the guess is. The search narrows by steps, so that what
  /// happens to lie near it does not bound the search at once, and not below half a metre.
  bool is_guess_vague = false;
  int max_iterations = 40;
  /// In the plane: surfaces across the main direction of the source have a robust scale of their
  /// own. The jambs of a few doors are all that tells the way along a corridor, and walls that fit
  /// already do not make outliers of them; but a person who walks along may be all as well.
  bool scale_across = false;
  /// Pulls the result where the surfaces leave it free, such as along a corridor.
  std::optional<PosePrior> prior;
};

/// Result of a registration.
struct Registration {
  enum class Termination { converged, iteration_limit, too_few_points };
  Termination termination = Termination::too_few_points;
  Pose T_target_source;
  /// Inverse covariance of T_target_source (tangent of Pose, frame source), from the normals and
  /// the residuals at the result, without the prior; rows of directions that the geometry does not
  /// fix are (near) zero.
  Matrix6d information = Matrix6d::Zero();
  /// Share of the source's points with a normal that meet a surface at the result, in [0, 1].
  double inlier_fraction = 0;
  /// Root mean square distance of the corresponding points along the normals, metres.
  double rmse_m = 0;
  int inliers = 0;
};

/// Robust point-to-surface registration of a source onto a target from a guess: Gauss-Newton on
///   sum_i w(r_i) r_i^2 / (sigma_i^2 + sigma_j^2),  r_i = n_j . (T_target_source p_i - q_j),
/// j the nearest target element whose normal agrees, w of Geman-McClure with a scale that follows
/// the residuals. Planar problems solve for x, y and rz, the others for all six.
///
/// The information counts a target element that many points share once, takes the chance part of
/// the normals' directions out (a corridor's walls say nothing about the way along it), widens with
/// the residuals' variance and their correlation from point to point, and never goes below what
/// range quantization leaves. Fewer than three usable points: too_few_points, the guess, no
/// information.
Registration register_surface(const Surface& source, const RegistrationTarget& target,
                              const Pose& T_target_source_guess,
                              const RegistrationOptions& options);

}  // namespace hmt::submap
