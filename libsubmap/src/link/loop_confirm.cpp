// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "loop_confirm.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace hmt::submap {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr size_t kMostSourcePoints = 500;
/// Of clouds more, for six unknowns instead of three.
constexpr size_t kMostCloudPoints = 2000;
/// Height and tilt of the prediction are off by the drift of a round.
constexpr double kCloudCorrespondenceM = 1.5;
constexpr double kLeastInliers = 0.5;
/// Of what was seen close by only a part is common: the two visits may look different ways.
constexpr double kLeastNearInliers = 0.4;
/// The match is on a grid of a decimetre; a registration that goes farther follows something else.
constexpr double kMostShiftM = 0.4;
constexpr double kMostTurnRad = 4.0 * kDegree;
/// Keyframes around the two centers that are registered closely.
constexpr double kSourceReachM = 1.5;
constexpr double kTargetReachM = 2.5;
/// A patch is bent by so much, one sigma: what the first registration cannot know better.
constexpr double kPatchSigmaM = 0.05;
constexpr double kPatchSigmaRad = 0.5 * kDegree;

/// The coordinates that a space has.
Eigen::ArrayXi axes_of(Space space) {
  if (space == Space::se2) return Eigen::ArrayXi{{0, 1, 5}};
  return Eigen::ArrayXi::LinSpaced(6, 0, 5);
}

/// 99.7 % of chi2 with as many degrees of freedom.
double gate2(Space space) {
  return space == Space::se2 ? 13.9 : 19.8;
}

size_t most_points(Space space) {
  return space == Space::se2 ? kMostSourcePoints : kMostCloudPoints;
}

/// Seen from above: a match tells nothing of height and tilt.
bool near(const Pose& left, const Pose& right) {
  return (left.translation - right.translation).head<2>().norm() < kMostShiftM &&
         std::abs(graph::wrap_angle(left.yaw_rad() - right.yaw_rad())) < kMostTurnRad;
}

/// Covariance over the coordinates of the space; directions without information get a metre or a
/// radian.
Eigen::MatrixXd covariance_in(Space space, const Matrix6d& information) {
  const Eigen::ArrayXi axes = axes_of(space);
  const Eigen::MatrixXd known = information(axes, axes);
  return (known + Eigen::MatrixXd::Identity(axes.size(), axes.size())).inverse();
}

Matrix6d in_space(Space space, const Eigen::MatrixXd& of_axes) {
  const Eigen::ArrayXi axes = axes_of(space);
  Matrix6d matrix = Matrix6d::Zero();
  matrix(axes, axes) = of_axes;
  return matrix;
}

Eigen::MatrixXd patch_bend(Space space) {
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(kPatchSigmaM), Eigen::Vector3d::Constant(kPatchSigmaRad);
  const Eigen::VectorXd variances = sigma.cwiseAbs2()(axes_of(space));
  return variances.asDiagonal();
}

/// Index of the keyframe of the map that stands nearest and looks most alike: a radian is a metre.
size_t nearest_keyframe(const LoopPatch& map, const Pose& T_map_query) {
  size_t nearest = 0;
  double least = 0;
  for (size_t i = 0; i < map.keyframes.size(); ++i) {
    const Pose T = graph::relative_pose(map.T_center_keyframe[i], T_map_query);
    const double cost = T.translation.norm() + std::abs(T.yaw_rad());
    if (i == 0 || cost < least) {
      nearest = i;
      least = cost;
    }
  }
  return nearest;
}

/// What the registration of a stretch of keyframes does not know of the one that it is told for:
/// how far they stand from it as a whole. The errors of the steps add up to both sides, and the
/// mean of such a walk has a third of the mean variance of its places. Frame of the keyframe.
Matrix6d drift_around(const LoopProblem& problem, const LoopPatch& patch, int keyframe,
                      const Pose& T_center_keyframe, double reach_m) {
  Matrix6d sum = Matrix6d::Zero();
  int count = 0;
  for (size_t i = 0; i < patch.keyframes.size(); ++i) {
    const Pose& T_center_other = patch.T_center_keyframe[i];
    if ((T_center_other.translation - T_center_keyframe.translation).norm() > reach_m) continue;
    ++count;
    if (patch.keyframes[i] == keyframe) continue;
    const auto covariance = problem.covariance(patch.keyframes[i], keyframe);
    if (covariance) sum += *covariance;
  }
  return sum / std::max(1, 3 * count);
}

/// (I^-1 + B)^-1, also where I is singular.
Eigen::MatrixXd widened(const Eigen::MatrixXd& information, const Eigen::MatrixXd& B) {
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(B.rows(), B.cols());
  const Eigen::MatrixXd wide = (identity + information * B).inverse() * information;
  return (wide + wide.transpose()) / 2;
}

bool agree(Space space, const Registration& forward, const Registration& backward) {
  const Pose T_backward = backward.T_target_source.inverse();
  const Eigen::VectorXd d = graph::boxminus(T_backward, forward.T_target_source)(axes_of(space));
  const Eigen::MatrixXd covariance = covariance_in(space, forward.information) +
                                     covariance_in(space, backward.information) + patch_bend(space);
  return d.dot(covariance.inverse() * d) < gate2(space);
}

std::string percent(const char* format, double share) {
  char buffer[120];
  std::snprintf(buffer, sizeof buffer, format, 100.0 * share);
  return buffer;
}

/// The close registration; the confirmation is left as it is where too little is common.
void refine(const PatchSurfaces& map, const PatchSurfaces& query, const Pose& T_map_a,
            RegistrationOptions options, LoopConfirmation& confirmation) {
  const RegistrationTarget target_a = make_target(surfaces_around(map, T_map_a, kTargetReachM));
  const RegistrationTarget target_b = make_target(surfaces_around(query, Pose{}, kTargetReachM));
  const Surface source_a = merged_surface(surfaces_around(map, T_map_a, kSourceReachM),
                                          query_range_m(options.space), most_points(options.space));
  const Surface source_b = merged_surface(surfaces_around(query, Pose{}, kSourceReachM),
                                          query_range_m(options.space), most_points(options.space));
  options.max_correspondence_m = RegistrationOptions{}.max_correspondence_m;
  options.prior = PosePrior{confirmation.T_a_b, confirmation.information};
  const Registration forward = register_surface(source_b, target_a, confirmation.T_a_b, options);
  options.prior.reset();
  const Registration backward =
      register_surface(source_a, target_b, forward.T_target_source.inverse(), options);
  if (forward.inlier_fraction < kLeastNearInliers || backward.inlier_fraction < kLeastNearInliers)
    return;
  if (!near(forward.T_target_source, confirmation.T_a_b) ||
      !agree(options.space, forward, backward)) {
    confirmation.objection = "the two ways of the close registration disagree";
    return;
  }
  confirmation.T_a_b = forward.T_target_source;
  confirmation.information += forward.information;
}

}  // namespace

void LoopConfirmer::load_map() {
  if (map_target_) return;
  map_surfaces_ = load_surfaces(problem_, map_);
  map_target_.emplace(make_target(map_surfaces_));
}

void LoopConfirmer::widen_by_drift(const LoopPatch& query, size_t index,
                                   LoopConfirmation& confirmation) const {
  const Matrix6d of_a =
      drift_around(problem_, map_, confirmation.a, map_.T_center_keyframe[index], kTargetReachM);
  const Matrix6d of_b = drift_around(problem_, query, query.center, Pose{}, kSourceReachM);
  const Matrix6d drift = graph::compose_covariance(confirmation.T_a_b, of_a, of_b);
  const Eigen::ArrayXi axes = axes_of(problem_.space);
  confirmation.information =
      in_space(problem_.space, widened(confirmation.information(axes, axes), drift(axes, axes)));
}

LoopConfirmation LoopConfirmer::confirm(const LoopPatch& query, const Pose& T_map_query) {
  load_map();
  const PatchSurfaces query_surfaces = load_surfaces(problem_, query);
  RegistrationOptions options;
  options.space = problem_.space;
  if (problem_.space == Space::se3) options.max_correspondence_m = kCloudCorrespondenceM;
  const Registration whole = register_surface(
      merged_surface(query_surfaces, query_range_m(problem_.space), most_points(problem_.space)),
      *map_target_, T_map_query, options);
  const size_t index = nearest_keyframe(map_, whole.T_target_source);
  const Pose& T_map_a = map_.T_center_keyframe[index];
  LoopConfirmation confirmation;
  confirmation.a = map_.keyframes[index];
  confirmation.T_a_b = graph::relative_pose(T_map_a, whole.T_target_source);
  confirmation.inlier_fraction = whole.inlier_fraction;
  confirmation.rmse_m = whole.rmse_m;
  if (whole.termination == Registration::Termination::too_few_points)
    confirmation.objection = "too few points to register";
  else if (!near(whole.T_target_source, T_map_query))
    confirmation.objection = "the registration left the match";
  else if (whole.inlier_fraction < kLeastInliers)
    confirmation.objection =
        percent("the registration explains only %.0f %% of the points", whole.inlier_fraction);
  if (!confirmation.objection.empty()) return confirmation;
  const Eigen::MatrixXd covariance =
      covariance_in(problem_.space, whole.information) + patch_bend(problem_.space);
  confirmation.information = in_space(problem_.space, covariance.inverse());
  refine(map_surfaces_, query_surfaces, T_map_a, options, confirmation);
  widen_by_drift(query, index, confirmation);
  return confirmation;
}

}  // namespace hmt::submap
