// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface_matches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hmt::submap {
namespace {

// Normals that differ by more than 45 degrees show different surfaces.
constexpr double kLeastNormalAgreement = 0.7;
// The scale of the robust weight in standard deviations of the bulk of the residuals.
constexpr double kScaleDeviations = 3;
// Standard deviation of a normal distribution over the median of its absolute values.
constexpr double kDeviationOverMedian = 1.4826;
// Vertical part of the normal of a level surface; so many matches tell how well they fit.
constexpr double kLevel = 0.7;
constexpr size_t kLeastLevel = 20;
// Cosine of the angle to the main normal of a scan from which on a surface lies across.
constexpr double kAcross = 0.7;
constexpr size_t kLeastAcross = 4;
// Seen in so many surfaces at the same place: a person who walks along is not.
constexpr int kStanding = 2;
// Neighbors on one surface are looked for at least this far.
constexpr double kLeastRadius_m = 0.15;
// From a vague guess: rings of a lidar lie metres apart on the ground, and a narrower search would
// find those points alone that happen to lie on each other. While a cloud is turned by ten degrees,
// only what is near it fits, and what fits would bound the search at once.
constexpr double kLeastVagueRadius_m = 0.5;
constexpr double kVagueNarrowing = 0.7;
constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

}  // namespace

double robust_weight(double residual_m, double scale_m) {
  const double s2 = scale_m * scale_m;
  const double ratio = s2 / (s2 + residual_m * residual_m);
  return ratio * ratio;
}

SurfaceMatcher::SurfaceMatcher(const Surface& source, const RegistrationTarget::Impl& target,
                               const RegistrationOptions& options)
    : source_(&source),
      target_(&target),
      last_(source.size(), kNone),
      across_(source.size(), 0),
      along_{options.max_correspondence_m, options.max_correspondence_m},
      across_reach_(along_),
      is_guess_vague_(options.is_guess_vague) {
  for (uint32_t i = 0; i < source.size(); ++i)
    if (!source.normals_robot[i].isZero(0)) usable_.push_back(i);
  matches_.reserve(usable_.size());
  if (options.scale_across) divide_source();
}

void SurfaceMatcher::divide_source() {
  // The doubled angle of a direction is that of its opposite, too.
  double cos2 = 0, sin2 = 0;
  for (const uint32_t i : usable_) {
    const Eigen::Vector3d& n = source_->normals_robot[i];
    cos2 += n.x() * n.x() - n.y() * n.y();
    sin2 += 2 * n.x() * n.y();
  }
  const double main_rad = std::atan2(sin2, cos2) / 2;
  const Eigen::Vector2d main(std::cos(main_rad), std::sin(main_rad));
  for (const uint32_t i : usable_)
    across_[i] = std::abs(source_->normals_robot[i].head<2>().dot(main)) < kAcross;
}

void SurfaceMatcher::match(const Pose& T_target_source) {
  matches_.clear();
  const Eigen::Matrix3d R = T_target_source.rotation_matrix();
  for (const uint32_t i : usable_) find_match(i, T_target_source, R);
  shrink();
}

void SurfaceMatcher::find_match(uint32_t i, const Pose& T_target_source, const Eigen::Matrix3d& R) {
  const Eigen::Vector3d& p_source = source_->points_robot[i];
  const Eigen::Vector3d p = R * p_source + T_target_source.translation;
  const Eigen::Vector3d n = R * source_->normals_robot[i];
  const double radius_m = (across_[i] != 0 ? across_reach_ : along_).radius_m;
  double best2 = radius_m * radius_m;
  uint32_t best = kNone;
  const int least_surfaces = across_[i] != 0 ? kStanding : 1;
  const auto visit = [&](size_t k) {
    const SurfaceElement& element = target_->elements[k];
    const double distance2 = (p - element.point).squaredNorm();
    if (distance2 < best2 && element.surfaces >= least_surfaces &&
        n.dot(element.normal) > kLeastNormalAgreement) {
      best2 = distance2;
      best = static_cast<uint32_t>(k);
    }
    return best2;
  };
  // The element of the last pose is mostly the nearest one still, and bounds the search.
  if (last_[i] != kNone) visit(last_[i]);
  target_->grid.visit_nearer(p, best2, visit);
  last_[i] = best;
  if (best == kNone) return;
  const SurfaceElement& element = target_->elements[best];
  const Eigen::Vector3d normal_source = R.transpose() * element.normal;
  Match match{.source = i, .element = best};
  match.residual_m = element.normal.dot(p - element.point);
  match.jacobian << normal_source, p_source.cross(normal_source);
  match.source_variance = source_->sigma_m[i] * source_->sigma_m[i];
  match.target_variance = element.variance;
  match.normal_variance = element.normal_variance;
  matches_.push_back(match);
}

bool SurfaceMatcher::is_level(const Match& match) const {
  return std::abs(target_->elements[match.element].normal.z()) > kLevel;
}

// Median of |residual| over the matches that belong; 0 where they are fewer than `least`.
template <typename Belongs>
double SurfaceMatcher::median_residual_m(const Belongs& belongs, size_t least) {
  sorted_.clear();
  for (const Match& match : matches_)
    if (belongs(match)) sorted_.push_back(std::abs(match.residual_m));
  if (sorted_.empty() || sorted_.size() < least) return 0;
  const auto middle = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_.size() / 2);
  std::nth_element(sorted_.begin(), middle, sorted_.end());
  return *middle;
}

template <typename Belongs>
void SurfaceMatcher::shrink(Reach& reach, double median_m, const Belongs& belongs) {
  double variance = 0;
  size_t count = 0;
  for (const Match& match : matches_) {
    if (!belongs(match)) continue;
    variance += match.variance();
    ++count;
  }
  const double noise_m = count == 0 ? 0 : std::sqrt(variance / static_cast<double>(count));
  const double wanted_m = kScaleDeviations * std::max(noise_m, kDeviationOverMedian * median_m);
  shrunk_ = shrunk_ || wanted_m < 0.99 * reach.scale_m;
  const bool stepwise = is_guess_vague_ && reach.scale_m > kLeastVagueRadius_m;
  const double narrower_m =
      stepwise ? std::max(wanted_m, kVagueNarrowing * reach.scale_m) : wanted_m;
  reach.scale_m = std::min(reach.scale_m, narrower_m);
  const double least_m = is_guess_vague_ ? kLeastVagueRadius_m : kLeastRadius_m;
  reach.radius_m = std::min(reach.radius_m, std::max(least_m, 2 * reach.scale_m));
  for (Match& match : matches_)
    if (belongs(match)) match.scale_m = reach.scale_m;
}

void SurfaceMatcher::shrink() {
  shrunk_ = false;
  if (matches_.empty()) return;
  const auto is_any = [](const Match&) { return true; };
  const auto across = [this](const Match& match) { return is_across(match); };
  const auto along = [this](const Match& match) { return !is_across(match); };
  if (median_residual_m(across, kLeastAcross) > 0) {
    shrink(along_, median_residual_m(along, 0), along);
    shrink(across_reach_, median_residual_m(across, 0), across);
    return;
  }
  // Ground may be a tenth of what is seen and is all that tells the height: walls that fit already
  // must not make outliers of it.
  const auto level = [this](const Match& match) { return is_level(match); };
  const auto upright = [this](const Match& match) { return !is_level(match); };
  shrink(along_, std::max(median_residual_m(upright, 0), median_residual_m(level, kLeastLevel)),
         is_any);
  across_reach_ = along_;
}

}  // namespace hmt::submap
