// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "locate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "hmt/submap/registration/correlative.hpp"
#include "information.hpp"
#include "search_space.hpp"
#include "seen_through.hpp"

namespace hmt::submap {
namespace {

// A registration is taken if so many of the usable points meet the local map; new sights open at
// less than half of the view from one observation to the next.
constexpr double kLeastInlierFraction = 0.5;
// Where most is new, such as in a turn or a door, so many must still meet the map, and as many of
// those for which the map leaves no other place.
constexpr double kLeastNewInlierFraction = 0.25;
constexpr double kKnownShare = 0.75;
// Clouds see farther: more of each is new.
constexpr double kLeastCloudInlierFraction = 0.3;
// Clouds fill the plane, so no search from above helps; surfaces stand metres apart, so a wide
// search for corresponding points does.
constexpr double kWideCorrespondence_m = 2.0;
// From a pose found on a coarse map.
constexpr double kNearCorrespondence_m = 1.0;
// Chi2 of three degrees of freedom beyond which a prediction is doubted (one in a thousand).
constexpr double kDoubtful2 = 16;
// A registration that contradicts the odometry needs more inliers: wheels slip and clocks jitter
// with heavy tails, hence the logarithm. 0.12 more at chi2 1000, about 30 standard deviations.
constexpr double kInliersPerDoubt = 0.03;
constexpr int kStarts = 3;
// Far from the odometry's guess nearly all must fit, and no other place so nearly as well.
constexpr double kLeastFarInlierFraction = 0.8;
constexpr double kAmbiguousShare = 0.85;
// ... and the odometry's own pose must be impossible: a view into a new room is not.
constexpr double kImpossibleShare = 0.3;
// With more inliers than this nothing can be seen through that makes a pose impossible.
constexpr double kClearInlierFraction = 0.85;
constexpr double kLeastWindow_m = 0.5, kLargestWindow_m = 2.0;
// Wheels that do not tell backwards from forwards are wrong by twice the step.
constexpr double kWorstStep = 2;
constexpr double kLeastWindow_rad = 0.3, kLargestWindow_rad = 1.0;

double least_inliers(Space space) {
  return space == Space::se2 ? kLeastInlierFraction : kLeastCloudInlierFraction;
}

/// What all steps of a search share.
class Locator {
 public:
  Locator(Space space, const Surface& surface, const LocalMap& map, const Prediction& prediction)
      : space_(space), surface_(surface), map_(map), prediction_(prediction) {}

  /// Where the walls leave the way along them to the prediction, the little that stands across them
  /// is given a chance to tell that a wheel slipped, if nearly all that is seen meets the map then.
  Registration near_prediction() const;
  /// In the plane.
  Registration search(const Registration& first) const;
  /// In space: registration from farther away.
  Registration search_wide(const Registration& first) const;
  /// In space: registrations from all around.
  Registration search_around(const Registration& first) const;
  bool is_doubtful(const Registration& found) const {
    return mahalanobis2(found) > kDoubtful2 || !fits(found);
  }
  /// What contradicts the prediction must not look through the map: people around the robot may
  /// leave so little of the map in view that a wrong pose fits better than the right one.
  bool is_trusted(const Registration& found) const {
    if (mahalanobis2(found) > kDoubtful2) return fits(found);
    return meets_enough(found) || meets_what_is_known(found);
  }

 private:
  Registration from_prediction(double max_correspondence_m, bool scale_across) const;
  bool meets_enough(const Registration& found) const {
    return credit(found) >= least_inliers(space_);
  }
  /// Whether most is in view for the first time and the rest meets the map.
  bool meets_what_is_known(const Registration& found) const;
  double mahalanobis2(const Registration& found) const;
  /// Inlier fraction less what the contradiction to the odometry costs.
  double credit(const Registration& found) const;
  /// Whether the surface would have looked through what stands in the plane.
  bool is_impossible(const Pose& T_map_robot) const;
  bool fits(const Registration& found) const;
  std::vector<CorrelativeMatch> matches(const CorrelativeWindow& window, double least_score) const {
    return correlative_search(surface_, map_.target(), prediction_.T_map_robot, window, kStarts,
                              least_score);
  }
  /// The odometry is as wrong as the pose says, but only in that direction: along a corridor, of
  /// which the pose knows nothing, it still counts.
  PosePrior prior_contradicted_by(const Pose& T_map_robot) const;
  Registration best_of(const std::vector<CorrelativeMatch>& matches,
                       const Registration& first) const;
  /// `near` where there is no match, or two that differ.
  Registration unambiguous(const CorrelativeWindow& window, double least_score,
                           const Registration& near) const;

  Space space_;
  const Surface& surface_;
  const LocalMap& map_;
  const Prediction& prediction_;
};

double Locator::mahalanobis2(const Registration& found) const {
  const Vector6d innovation = graph::boxminus(found.T_target_source, prediction_.T_map_robot);
  return innovation.dot(prediction_.information * innovation);
}

double Locator::credit(const Registration& found) const {
  if (found.termination == Registration::Termination::too_few_points) return 0;
  const double doubt = mahalanobis2(found) / kDoubtful2;
  return found.inlier_fraction - kInliersPerDoubt * std::log(std::max(1.0, doubt));
}

bool Locator::is_impossible(const Pose& T_map_robot) const {
  return space_ == Space::se2 &&
         seen_through_share(surface_, map_.target(), T_map_robot) >= kImpossibleShare;
}

bool Locator::meets_what_is_known(const Registration& found) const {
  if (space_ == Space::se3 || found.termination == Registration::Termination::too_few_points ||
      found.inlier_fraction < kLeastNewInlierFraction || is_impossible(found.T_target_source))
    return false;
  const double standing = standing_in_view_share(surface_, map_.surfaces(), found.T_target_source);
  return found.inlier_fraction >= kKnownShare * (found.inlier_fraction + standing);
}

bool Locator::fits(const Registration& found) const {
  return meets_enough(found) &&
         (found.inlier_fraction >= kClearInlierFraction || !is_impossible(found.T_target_source));
}

Registration Locator::from_prediction(double max_correspondence_m, bool scale_across) const {
  RegistrationOptions options;
  options.space = space_;
  options.max_correspondence_m = max_correspondence_m;
  options.scale_across = scale_across;
  options.prior = PosePrior{prediction_.T_map_robot, prediction_.information};
  return register_surface(surface_, map_.target(), prediction_.T_map_robot, options);
}

Registration Locator::near_prediction() const {
  const Registration found = from_prediction(RegistrationOptions{}.max_correspondence_m, false);
  if (space_ == Space::se3 || observes_all(space_, found.information, prediction_.information))
    return found;
  const Registration across = from_prediction(RegistrationOptions{}.max_correspondence_m, true);
  const bool clear = across.inlier_fraction >= kClearInlierFraction;
  return clear && credit(across) > credit(found) ? across : found;
}

PosePrior Locator::prior_contradicted_by(const Pose& T_map_robot) const {
  const Vector6d error = graph::boxminus(T_map_robot, prediction_.T_map_robot);
  return {prediction_.T_map_robot,
          inverse_in(space_, prediction_.covariance + 4 * error * error.transpose())};
}

Registration Locator::best_of(const std::vector<CorrelativeMatch>& matches,
                              const Registration& first) const {
  std::vector<Pose> starts{first.T_target_source};
  for (const CorrelativeMatch& match : matches) starts.push_back(match.T_target_source);
  Registration best = first;
  for (const Pose& start : starts) {
    RegistrationOptions options;
    options.space = space_;
    options.prior = prior_contradicted_by(start);
    const Registration found = register_surface(surface_, map_.target(), start, options);
    if (credit(found) > credit(best)) best = found;
  }
  return best;
}

Registration Locator::unambiguous(const CorrelativeWindow& window, double least_score,
                                  const Registration& near) const {
  const std::vector<CorrelativeMatch> far = matches(window, least_score);
  const bool ambiguous = far.size() > 1 && far[1].score > kAmbiguousShare * far[0].score;
  return ambiguous ? near : best_of(far, near);
}

Registration Locator::search(const Registration& first) const {
  const Eigen::Matrix2d planar = prediction_.covariance.topLeftCorner<2, 2>();
  const double sigma_m = std::sqrt(planar.trace());
  const double sigma_rad = std::sqrt(prediction_.covariance(5, 5));
  const CorrelativeWindow window{std::clamp(5 * sigma_m, kLeastWindow_m, kLargestWindow_m),
                                 std::clamp(5 * sigma_rad, kLeastWindow_rad, kLargestWindow_rad)};
  const Registration near = best_of(matches(window, 0), first);
  if (fits(near) || !is_impossible(prediction_.T_map_robot)) return near;
  const Registration beyond =
      unambiguous({kLargestWindow_m + kWorstStep * prediction_.step_m, window.half_angle_rad},
                  kLeastInlierFraction, near);
  if (fits(beyond)) return beyond;
  const Registration turned =
      unambiguous({kLargestWindow_m, std::numbers::pi}, kLeastFarInlierFraction, near);
  return turned.inlier_fraction >= kLeastFarInlierFraction ? turned : near;
}

Registration Locator::search_wide(const Registration& first) const {
  const Registration found = from_prediction(kWideCorrespondence_m, false);
  return credit(found) > credit(first) ? found : first;
}

Registration Locator::search_around(const Registration& first) const {
  if (first.inlier_fraction >= kClearInlierFraction) return first;
  const std::array guesses{prediction_.T_map_robot, prediction_.T_map_latest};
  Registration best = first;
  double best_share = met_share(surface_, map_.target(), first.T_target_source);
  for (const SpaceMatch& match : search_space(surface_, map_.target(), guesses)) {
    RegistrationOptions options;
    options.space = space_;
    options.max_correspondence_m = kNearCorrespondence_m;
    options.is_guess_vague = true;
    options.prior = prior_contradicted_by(match.T_map_robot);
    const Registration found =
        register_surface(surface_, map_.target(), match.T_map_robot, options);
    const double share = met_share(surface_, map_.target(), found.T_target_source);
    if (share <= best_share) continue;
    best = found;
    best_share = share;
  }
  return best;
}

}  // namespace

LocatedSurface locate(Space space, const Surface& surface, const LocalMap& map,
                      const Prediction& prediction, bool blind) {
  const Locator locator(space, surface, map, prediction);
  LocatedSurface located;
  located.registration = locator.near_prediction();
  // A guess may be so far off that a wrong pose fits well enough.
  if (blind || locator.is_doubtful(located.registration)) {
    located.searched = true;
    located.registration = space == Space::se2 ? locator.search(located.registration)
                                               : locator.search_wide(located.registration);
    if (blind && space == Space::se3)
      located.registration = locator.search_around(located.registration);
  }
  located.fits = locator.is_trusted(located.registration);
  return located;
}

}  // namespace hmt::submap
