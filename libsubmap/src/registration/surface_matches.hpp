// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "registration_target.hpp"

namespace hmt::submap {

/// A source point and the target element nearest to it.
struct Match {
  uint32_t source = 0;   ///< index of the point in the source
  uint32_t element = 0;  ///< index of the element in the target
  double residual_m = 0;
  /// d residual / d tangent of T_target_source (frame source).
  Vector6d jacobian = Vector6d::Zero();
  double source_variance = 0;
  double target_variance = 0;
  double normal_variance = 0;
  double scale_m = 0;  ///< of the robust weight: residuals beyond it are outliers

  double variance() const { return source_variance + target_variance; }
};

/// Weight of Geman-McClure: (s^2 / (s^2 + r^2))^2, 1 at r = 0 and 1/4 at r = s.
double robust_weight(double residual_m, double scale_m);

/// Finds matches at changing poses, with a search radius and a robust scale that shrink with the
/// residuals from call to call, as the options say.
class SurfaceMatcher {
 public:
  SurfaceMatcher(const Surface& source, const RegistrationTarget::Impl& target,
                 const RegistrationOptions& options);

  void match(const Pose& T_target_source);
  const std::vector<Match>& matches() const { return matches_; }
  /// Whether the last call narrowed a scale by more than a percent.
  bool shrunk() const { return shrunk_; }
  /// Number of source points that have a normal.
  size_t usable() const { return usable_.size(); }
  const Surface& source() const { return *source_; }

 private:
  /// How far matches are looked for, and from which residual on they are outliers.
  struct Reach {
    double radius_m = 0;
    double scale_m = 0;
  };

  void divide_source();
  void find_match(uint32_t i, const Pose& T_target_source, const Eigen::Matrix3d& R);
  bool is_across(const Match& match) const { return across_[match.source] != 0; }
  bool is_level(const Match& match) const;
  template <typename Belongs>
  double median_residual_m(const Belongs& belongs, size_t least);
  template <typename Belongs>
  void shrink(Reach& reach, double median_m, const Belongs& belongs);
  void shrink();

  const Surface* source_;
  const RegistrationTarget::Impl* target_;
  std::vector<uint32_t> usable_;
  std::vector<uint32_t> last_;  // element that each source point met last
  std::vector<char> across_;    // whether a source point is on a surface across the main direction
  std::vector<Match> matches_;
  std::vector<double> sorted_;
  Reach along_;
  Reach across_reach_;
  bool is_guess_vague_;
  bool shrunk_ = true;
};

}  // namespace hmt::submap
