// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_noise.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

namespace hmt::submap {
namespace {

// Turning by a radian moves the wheels of a robot about as much as driving this far.
constexpr double kTurnLength_m = 0.3;
/// At rest a robot may still shift by so much from one observation to the next.
constexpr double kRest_m = 1e-3;
constexpr double kRest_rad = 5e-4;
/// A millimetre, a milliradian: no measurement is better, even where a robot at rest repeats one.
constexpr double kLeastLogDeviation = -6.9;
/// Observations that the noise is learnt from: enough for five numbers to some percent.
constexpr size_t kMostObservations = 20000;
/// Keyframes apart from which two sightings of a landmark are independent. From nearer by, what is
/// wrong with one (its lighting, its direction in the lens) is wrong with the other.
constexpr double kNewView = 4;
/// Share of measurements that may be false.
constexpr double kFalseShare = 0.02;
/// Steps of the search, in the logarithm of a deviation: from a factor of 2.7 down to 4 percent.
constexpr double kFirstStep = 1.0;
constexpr double kLastStep = 0.04;
/// Steps of the logarithm of a scale are so much smaller, and no odometry is wrong by more than a
/// third.
constexpr double kScaleStep = 0.1;
constexpr double kMostScale = 0.3;

bool lacks_motion(const Observation& observation) {
  return !observation.motion_covariance;
}

bool lacks_covariance(const Landmark& landmark) {
  return landmark.covariance_sensor.isZero(0);
}

bool lacks_covariance(const Observation& observation) {
  return std::any_of(observation.landmark_readings.begin(), observation.landmark_readings.end(),
                     [](const LandmarkReading& reading) {
                       return std::any_of(reading.landmarks.begin(), reading.landmarks.end(),
                                          [](const Landmark& l) { return lacks_covariance(l); });
                     });
}

/// For every sighting of a log, in its order, which view it belongs to, and how many are in a view.
struct Views {
  Views(std::span<const Observation> observations, const TrackOptions& options) {
    struct Latest {
      Pose T_odom_robot;
      size_t view;
    };
    std::map<int64_t, Latest> latest;  // by name
    for (const Observation& observation : observations)
      for (const LandmarkReading& reading : observation.landmark_readings)
        for (const Landmark& landmark : reading.landmarks) {
          const auto found = latest.find(landmark.id);
          const bool is_new =
              landmark.id == kUnknownLandmark || found == latest.end() ||
              has_moved(found->second.T_odom_robot, observation.T_odom_robot, options);
          if (is_new) {
            latest[landmark.id] = {observation.T_odom_robot, size.size()};
            size.push_back(0);
          }
          view_of.push_back(latest[landmark.id].view);
          is_first.push_back(is_new);
          ++size[view_of.back()];
        }
  }

  static bool has_moved(const Pose& T_odom_before, const Pose& T_odom_now,
                        const TrackOptions& options) {
    const Pose T = graph::relative_pose(T_odom_before, T_odom_now);
    return T.translation.norm() >= kNewView * options.keyframe_distance_m ||
           2 * std::atan2(T.rotation.vec().norm(), std::abs(T.rotation.w())) >=
               kNewView * options.keyframe_angle_rad;
  }

  std::vector<size_t> view_of;  ///< by sighting
  std::vector<bool> is_first;   ///< by sighting: of its view
  std::vector<int> size;        ///< by view
};

/// The likelihood of a log for any noise.
class Likelihood {
 public:
  Likelihood(std::span<const Observation> observations, Space space, const Views& views)
      : observations_(observations), space_(space), views_(views) {
    double range_m = 1;
    for (const Observation& observation : observations)
      for (const LandmarkReading& reading : observation.landmark_readings)
        for (const Landmark& l : reading.landmarks)
          range_m = std::max(range_m, l.position_sensor.norm());
    const double pi = std::numbers::pi;
    const double view =
        space == Space::se2 ? pi * range_m * range_m : 4 * pi / 3 * range_m * range_m * range_m;
    false_density_ = kFalseShare / view;
  }

  /// Logarithm, without constants.
  double operator()(const LandmarkNoise& noise) const {
    LandmarkFilter filter(space_, Pose{});
    const Pose* T_odom_latest = &observations_.front().T_odom_robot;
    double sum = 0;
    size_t sighting = 0;
    for (const Observation& observation : observations_) {
      const Pose told = graph::relative_pose(*T_odom_latest, observation.T_odom_robot);
      const Pose step = lacks_motion(observation) ? noise.calibrated(told) : told;
      filter.predict(step, observation.motion_covariance.value_or(noise.of_motion(space_, step)));
      T_odom_latest = &observation.T_odom_robot;
      for (const LandmarkReading& reading : observation.landmark_readings)
        for (const Landmark& landmark : reading.landmarks)
          if (views_.is_first[sighting++])
            sum += add(filter, measured(reading, landmark, noise), static_cast<int>(landmark.id));
    }
    return sum;
  }

 private:
  MeasuredLandmark measured(const LandmarkReading& reading, const Landmark& landmark,
                            const LandmarkNoise& noise) const {
    const Eigen::Matrix3d R = reading.T_robot_sensor.rotation_matrix();
    const Eigen::Matrix3d covariance = lacks_covariance(landmark)
                                           ? noise.of_landmark(space_, landmark.position_sensor)
                                           : landmark.covariance_sensor;
    return {reading.T_robot_sensor * landmark.position_sensor, R * covariance * R.transpose()};
  }

  double add(LandmarkFilter& filter, const MeasuredLandmark& measured, int landmark) const {
    const auto innovation = filter.innovation(landmark, measured);
    if (!innovation) {
      filter.insert(landmark, measured);
      return 0;
    }
    const double dimension = space_ == Space::se2 ? 2 : 3;
    const double density =
        (1 - kFalseShare) *
        std::exp(-0.5 * (innovation->mahalanobis_squared + innovation->log_determinant +
                         dimension * std::log(2 * std::numbers::pi)));
    if (density > false_density_) filter.update(landmark, measured);
    return std::log(density + false_density_);
  }

  std::span<const Observation> observations_;
  Space space_;
  const Views& views_;
  double false_density_ = 0;
};

/// Changes one number of the noise by a step of the search.
using Move = std::function<void(LandmarkNoise&, double)>;

std::vector<Move> moves(bool motion, bool landmarks) {
  std::vector<Move> moves;
  const auto add_deviation = [&moves](size_t k) {
    moves.emplace_back([k](LandmarkNoise& noise, double step) {
      noise.log_deviation[k] = std::max(kLeastLogDeviation, noise.log_deviation[k] + step);
    });
  };
  const auto add_scale = [&moves](size_t k) {
    moves.emplace_back([k](LandmarkNoise& noise, double step) {
      noise.log_scale[k] =
          std::clamp(noise.log_scale[k] + kScaleStep * step, -kMostScale, kMostScale);
    });
  };
  for (size_t k = 0; landmarks && k < 3; ++k) add_deviation(k);
  for (size_t k = 3; motion && k < 5; ++k) add_deviation(k);
  for (size_t k = 0; motion && k < 2; ++k) add_scale(k);
  return moves;
}

}  // namespace

Pose LandmarkNoise::calibrated(const Pose& T_before_now) const {
  const Eigen::AngleAxisd turn(T_before_now.rotation);
  Pose T = T_before_now;
  T.translation *= std::exp(log_scale[0]);
  T.rotation =
      Eigen::AngleAxisd(graph::wrap_angle(turn.angle()) * std::exp(log_scale[1]), turn.axis());
  return T;
}

Eigen::Matrix3d LandmarkNoise::of_landmark(Space space,
                                           const Eigen::Vector3d& position_sensor) const {
  const double range_m = position_sensor.norm();
  const double along =
      std::exp(2 * log_deviation[0]) + std::exp(2 * log_deviation[1]) * range_m * range_m;
  const double across = std::exp(2 * log_deviation[2]) * range_m * range_m;
  const Eigen::Vector3d sight =
      range_m > 0 ? Eigen::Vector3d(position_sensor / range_m) : Eigen::Vector3d::UnitX();
  Eigen::Matrix3d covariance =
      across * Eigen::Matrix3d::Identity() + (along - across) * sight * sight.transpose();
  if (space == Space::se2) {
    covariance.row(2).setZero();
    covariance.col(2).setZero();
  }
  return covariance;
}

Matrix6d LandmarkNoise::of_motion(Space space, const Pose& T_before_now) const {
  const double distance_m = T_before_now.translation.norm();
  const double angle_rad =
      2 * std::atan2(T_before_now.rotation.vec().norm(), std::abs(T_before_now.rotation.w()));
  const double translation =
      kRest_m * kRest_m + std::exp(2 * log_deviation[3]) * (distance_m + kTurnLength_m * angle_rad);
  const double rotation = kRest_rad * kRest_rad + std::exp(2 * log_deviation[4]) *
                                                      (angle_rad + distance_m / kTurnLength_m / 10);
  Vector6d variances;
  variances << translation, translation, translation, rotation, rotation, rotation;
  if (space == Space::se2) variances.segment<3>(2).setZero();
  return variances.asDiagonal();
}

std::vector<Observation> with_noise(std::vector<Observation> observations, Space space,
                                    const TrackOptions& options, LandmarkNoise& noise) {
  // The first observation has no motion before it.
  const bool motion = std::any_of(observations.begin() + 1, observations.end(), lacks_motion);
  const bool landmarks = std::any_of(observations.begin(), observations.end(),
                                     [](const Observation& o) { return lacks_covariance(o); });
  if (!motion && !landmarks) return observations;
  const Views views(observations, options);
  const Likelihood likelihood(std::span<const Observation>(observations)
                                  .first(std::min(observations.size(), kMostObservations)),
                              space, views);
  double best = likelihood(noise);
  for (double step = kFirstStep; step >= kLastStep;) {
    const double before = best;
    for (const Move& move : moves(motion, landmarks))
      for (const double sign : {-1.0, 1.0}) {
        LandmarkNoise moved = noise;
        move(moved, sign * step);
        const double value = likelihood(moved);
        if (value <= best) continue;
        best = value;
        noise = moved;
        break;
      }
    if (best == before) step /= 2;
  }
  Pose T_odom_latest = observations.front().T_odom_robot;  // as the log tells it
  Pose T_odom_robot = T_odom_latest;
  size_t sighting = 0;
  for (Observation& observation : observations) {
    Pose step = graph::relative_pose(T_odom_latest, observation.T_odom_robot);
    T_odom_latest = observation.T_odom_robot;
    if (!observation.motion_covariance) {
      step = noise.calibrated(step);
      observation.motion_covariance = noise.of_motion(space, step);
    }
    observation.T_odom_robot = T_odom_robot = T_odom_robot * step;
    for (LandmarkReading& reading : observation.landmark_readings)
      for (Landmark& landmark : reading.landmarks) {
        const int same_view = views.size[views.view_of[sighting++]];
        if (lacks_covariance(landmark))
          landmark.covariance_sensor =
              same_view * noise.of_landmark(space, landmark.position_sensor);
      }
  }
  return observations;
}

}  // namespace hmt::submap
