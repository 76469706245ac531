// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tracker.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "information.hpp"
#include "seen_through.hpp"

namespace hmt::submap {
namespace {

// Covariance of a step about which odometry says nothing: people walk, robots drive this far
// between two scans.
constexpr double kUnknownStep_m = 1.0;
constexpr double kUnknownStep_rad = 0.5;
// A pose that defines the map has no error against it.
constexpr double kDefining = 1e12;
// Information so small (100 m, 100 rad) that it says nothing.
constexpr double kNothing = 1e-4;

Matrix6d diagonal_in(Space space, double translation, double rotation) {
  Vector6d v;
  v << translation, translation, translation, rotation, rotation, rotation;
  if (space == Space::se2) v.segment<3>(2).setZero();
  return v.asDiagonal();
}

Matrix6d unknown_step(Space space) {
  return diagonal_in(space, kUnknownStep_m * kUnknownStep_m, kUnknownStep_rad * kUnknownStep_rad);
}

// A registration is taken if so many of the usable points meet the local map; new sights open at
// less than half of the view from one observation to the next.
constexpr double kLeastInlierFraction = 0.5;
// Clouds see farther: more of each is new.
constexpr double kLeastCloudInlierFraction = 0.3;
// Clouds fill the plane, so no search from above helps; surfaces stand metres apart, so a wide
// search for corresponding points does.
constexpr double kWideCorrespondence_m = 2.0;
// Chi2 of three degrees of freedom beyond which a prediction is doubted (one in a thousand).
constexpr double kDoubtful2 = 16;
// A registration that contradicts the odometry needs more inliers: wheels slip and clocks jitter
// with heavy tails, hence the logarithm. 0.12 more at chi2 1000, about 30 standard deviations.
constexpr double kInliersPerDoubt = 0.03;
constexpr int kStarts = 3;
constexpr int kMostRefused = 10;
// Far from the odometry's guess nearly all must fit, and no other place so nearly as well.
constexpr double kLeastFarInlierFraction = 0.8;
constexpr double kAmbiguousShare = 0.85;
// ... and the odometry's own pose must be impossible: a view into a new room is not.
constexpr double kImpossibleShare = 0.3;
constexpr double kLeastWindow_m = 0.5, kLargestWindow_m = 2.0;
constexpr double kLeastWindow_rad = 0.3, kLargestWindow_rad = 1.0;

// Whether the registration told more than the prediction in every direction.
bool observes_all(Space space, const Matrix6d& information, const Matrix6d& predicted) {
  const Eigen::ArrayXi used =
      space == Space::se2 ? Eigen::ArrayXi{{0, 1, 5}} : Eigen::ArrayXi{{0, 1, 2, 3, 4, 5}};
  const Eigen::MatrixXd measured = information(used, used);
  const Eigen::MatrixXd prior = predicted(used, used);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(measured, prior);
  return eigen.eigenvalues()[0] > 1;
}

double rotation_angle_rad(const Pose& T) {
  return 2 * std::atan2(T.rotation.vec().norm(), std::abs(T.rotation.w()));
}

}  // namespace

Tracker::Tracker(Space space, const TrackOptions& options)
    : space_(space),
      options_(options),
      step_odometry_(space),
      keyframe_odometry_(space),
      steady_(OdometryModel::of_unknown_motion(space)) {
  track_.space = space;
}

void Tracker::start(const Observation& observation, Surface surface) {
  T_track_latest_ = observation.T_odom_robot;
  add_keyframe(observation,
               {T_track_latest_, diagonal_in(space_, kDefining, kDefining), true, T_track_latest_},
               std::move(surface));
}

void Tracker::add(const Observation& observation, Surface surface) {
  if (track_.keyframes.empty()) {
    start(observation, std::move(surface));
  } else {
    const Motion motion = predict_step(observation);
    const Pose& step = motion.step;
    Matrix6d step_covariance = motion.covariance;
    // Where the odometry's word was taken against the surfaces, it is trusted less and less.
    step_covariance *= std::exp2(2 * std::min(refused_, kMostRefused));
    T_keyframe_odometry_ = T_keyframe_odometry_ * step;
    const Matrix6d covariance = compose_covariance(step, covariance_latest_, step_covariance);
    const Prediction prediction{T_track_latest_ * step, covariance, inverse_in(space_, covariance)};
    const Estimate found = estimate(surface, prediction);
    learn_odometry(motion, prediction, found);
    latest_step_ = relative_pose(T_track_latest_, found.T_track_robot);
    latest_duration_s_ = motion.duration_s;
    T_track_latest_ = found.T_track_robot;
    covariance_latest_ =
        found.registered ? inverse_in(space_, inverse_in(space_, covariance) + found.information)
                         : covariance;
    const Pose T_keyframe_robot =
        relative_pose(track_.keyframes.back().T_track_robot, T_track_latest_);
    if (T_keyframe_robot.translation.norm() >= options_.keyframe_distance_m ||
        rotation_angle_rad(T_keyframe_robot) >= options_.keyframe_angle_rad)
      add_keyframe(observation, found, std::move(surface));
  }
  T_odom_latest_ = observation.T_odom_robot;
  stamp_latest_s_ = observation.stamp_s;
  const Keyframe& keyframe = track_.keyframes.back();
  track_.observations.push_back({observation.index, observation.stamp_s, keyframe.id,
                                 relative_pose(keyframe.T_track_robot, T_track_latest_)});
}

Tracker::Motion Tracker::predict_step(const Observation& observation) {
  Motion motion;
  motion.odometry = relative_pose(T_odom_latest_, observation.T_odom_robot);
  motion.duration_s = std::max(0.0, observation.stamp_s - stamp_latest_s_);
  if (!OdometryModel::is_motion(motion.odometry)) {
    motion.covariance = unknown_step(space_);
    odometry_unbroken_ = false;
    ++counts_.odometry_jumps;
    return motion;
  }
  odometry_moves_ = odometry_moves_ || !OdometryModel::is_rest(motion.odometry);
  if (!odometry_moves_) {
    const double longer = latest_duration_s_ > 0 ? motion.duration_s / latest_duration_s_ : 1;
    motion.step = boxplus(Pose{}, std::min(longer, 2.0) * boxminus(latest_step_, Pose{}));
    motion.covariance = steady_.covariance(motion.step);
    odometry_unbroken_ = false;
    return motion;
  }
  motion.by_odometry = odometry_unbroken_;
  motion.step = space_ == Space::se2 ? calibration_.corrected(motion.odometry, motion.duration_s)
                                     : motion.odometry;
  motion.covariance = step_odometry_.covariance(motion.step);
  return motion;
}

void Tracker::learn_odometry(const Motion& motion, const Prediction& prediction,
                             const Estimate& found) {
  if (!found.registered) return;
  const Matrix6d noise = inverse_in(space_, found.information + kNothing * Matrix6d::Identity());
  if (motion.by_odometry && space_ == Space::se2) {
    const Eigen::Array3i plane(0, 1, 5);
    const Vector6d free = boxminus(found.T_track_measured, prediction.T_track_robot);
    const Eigen::Matrix3d covariance = (noise + prediction.covariance)(plane, plane);
    const Eigen::Array2i along(0, 2);
    calibration_.learn(motion.odometry, motion.duration_s, free(plane)(along),
                       covariance(along, along));
  }
  const Pose measured = relative_pose(T_track_latest_, found.T_track_robot);
  if (space_ == Space::se3) {
    if (motion.by_odometry)
      step_odometry_.learn(
          motion.step, relative_pose(T_track_latest_, found.T_track_measured),
          (noise + compose_covariance(motion.step, covariance_latest_, Matrix6d::Zero()))
              .diagonal());
    if (!odometry_moves_) steady_.learn(motion.step, measured, Vector6d::Zero());
    return;
  }
  if (!observes_all(space_, found.information, prediction.information)) return;
  if (motion.by_odometry) step_odometry_.learn(motion.step, measured, Vector6d::Zero());
  if (!odometry_moves_) steady_.learn(motion.step, measured, Vector6d::Zero());
}

double Tracker::mahalanobis2(const Pose& T_track_robot, const Prediction& prediction) const {
  const Vector6d innovation = boxminus(T_track_robot, prediction.T_track_robot);
  return innovation.dot(prediction.information * innovation);
}

double Tracker::credit(const Registration& registration, const Prediction& prediction) const {
  if (registration.termination == Registration::Termination::too_few_points) return 0;
  const double doubt = mahalanobis2(registration.T_target_source, prediction) / kDoubtful2;
  return registration.inlier_fraction - kInliersPerDoubt * std::log(std::max(1.0, doubt));
}

Tracker::Estimate Tracker::estimate(const Surface& surface, const Prediction& prediction) {
  RegistrationOptions options;
  options.space = space_;
  options.prior = PosePrior{prediction.T_track_robot, prediction.information};
  Registration found = register_surface(surface, map_.target(), prediction.T_track_robot, options);
  // Without odometry the guess may be so far off that a wrong pose fits well enough.
  const double least = space_ == Space::se2 ? kLeastInlierFraction : kLeastCloudInlierFraction;
  if (!odometry_moves_ || credit(found, prediction) < least ||
      mahalanobis2(found.T_target_source, prediction) > kDoubtful2) {
    found = space_ == Space::se2 ? search(surface, prediction, found)
                                 : search_wide(surface, prediction, found);
    if (credit(found, prediction) < least) {
      ++counts_.odometry_only;
      if (found.termination != Registration::Termination::too_few_points) ++refused_;
      return {prediction.T_track_robot, Matrix6d::Zero(), false, prediction.T_track_robot};
    }
    ++counts_.searched;
  }
  ++counts_.registered;
  refused_ = 0;
  // The estimate lies between the prediction p and what the surfaces alone say, m:
  // x - p = (I + P)^-1 I (m - p) with their informations I and P.
  const Vector6d moved = boxminus(found.T_target_source, prediction.T_track_robot);
  const Matrix6d noise = inverse_in(space_, found.information + kNothing * Matrix6d::Identity());
  const Vector6d free = moved + noise * (prediction.information * moved);
  return {found.T_target_source, found.information, true, boxplus(prediction.T_track_robot, free)};
}

Registration Tracker::search(const Surface& surface, const Prediction& prediction,
                             const Registration& first) {
  const Eigen::Matrix2d planar = prediction.covariance.topLeftCorner<2, 2>();
  const double sigma_m = std::sqrt(planar.trace());
  const double sigma_rad = std::sqrt(prediction.covariance(5, 5));
  const CorrelativeWindow window{std::clamp(5 * sigma_m, kLeastWindow_m, kLargestWindow_m),
                                 std::clamp(5 * sigma_rad, kLeastWindow_rad, kLargestWindow_rad)};
  const auto matches_within = [&](const CorrelativeWindow& within) {
    return correlative_search(surface, map_.target(), prediction.T_track_robot, within, kStarts);
  };
  const Registration near = best_of(matches_within(window), surface, prediction, first);
  if (credit(near, prediction) >= kLeastInlierFraction) return near;
  if (seen_through_share(surface, map_.target(), prediction.T_track_robot) < kImpossibleShare)
    return near;
  const std::vector<CorrelativeMatch> far = matches_within({kLargestWindow_m, std::numbers::pi});
  if (far.size() > 1 && far[1].score > kAmbiguousShare * far[0].score) return near;
  const Registration best = best_of(far, surface, prediction, near);
  return best.inlier_fraction >= kLeastFarInlierFraction ? best : near;
}

Registration Tracker::search_wide(const Surface& surface, const Prediction& prediction,
                                  const Registration& first) const {
  RegistrationOptions options;
  options.space = space_;
  options.max_correspondence_m = kWideCorrespondence_m;
  options.prior = PosePrior{prediction.T_track_robot, prediction.information};
  const Registration found =
      register_surface(surface, map_.target(), prediction.T_track_robot, options);
  return credit(found, prediction) > credit(first, prediction) ? found : first;
}

Registration Tracker::best_of(const std::vector<CorrelativeMatch>& matches, const Surface& surface,
                              const Prediction& prediction, const Registration& first) const {
  std::vector<Pose> starts{first.T_target_source};
  for (const CorrelativeMatch& match : matches) starts.push_back(match.T_target_source);
  Registration best = first;
  for (const Pose& start : starts) {
    // The odometry is as wrong as the start says, but only in that direction: along a corridor, of
    // which the start knows nothing, it still counts.
    const Vector6d error = boxminus(start, prediction.T_track_robot);
    RegistrationOptions options;
    options.space = space_;
    options.prior =
        PosePrior{prediction.T_track_robot,
                  inverse_in(space_, prediction.covariance + 4 * error * error.transpose())};
    const Registration found = register_surface(surface, map_.target(), start, options);
    if (credit(found, prediction) > credit(best, prediction)) best = found;
  }
  return best;
}

void Tracker::add_keyframe(const Observation& observation, const Estimate& estimate,
                           Surface surface) {
  if (!track_.keyframes.empty()) {
    const Keyframe& previous = track_.keyframes.back();
    const Pose T_a_b = relative_pose(previous.T_track_robot, estimate.T_track_robot);
    const Matrix6d by_registration =
        compose_information(space_, T_a_b, information_keyframe_, estimate.information);
    Matrix6d by_odometry =
        odometry_unbroken_ ? inverse_in(space_, keyframe_odometry_.covariance(T_keyframe_odometry_))
                           : inverse_in(space_, unknown_step(space_));
    // Odometry that the surfaces contradict is as wrong as they say.
    const Vector6d error = boxminus(T_a_b, T_keyframe_odometry_);
    const double unknowns = space_ == Space::se2 ? 3 : 6;
    by_odometry /= std::max(1.0, error.dot(by_odometry * error) / unknowns);
    track_.odometry.push_back({previous.id, previous.id + 1, ConstraintKind::odometry, T_a_b,
                               by_registration + by_odometry});
    if (odometry_unbroken_ && space_ == Space::se3 && estimate.registered)
      keyframe_odometry_.learn(
          T_keyframe_odometry_, relative_pose(previous.T_track_robot, estimate.T_track_measured),
          inverse_in(space_, by_registration + kNothing * Matrix6d::Identity()).diagonal());
    else if (odometry_unbroken_ && observes_all(space_, by_registration, by_odometry))
      keyframe_odometry_.learn(T_keyframe_odometry_, T_a_b, Vector6d::Zero());
  }
  track_.keyframes.push_back({static_cast<int>(track_.keyframes.size()), observation.index,
                              observation.stamp_s, estimate.T_track_robot});
  map_.add(estimate.T_track_robot, std::move(surface));
  T_keyframe_odometry_ = Pose{};
  information_keyframe_ = estimate.information;
  odometry_unbroken_ = true;
}

}  // namespace hmt::submap
