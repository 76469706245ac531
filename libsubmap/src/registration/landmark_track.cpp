// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_track.hpp"

#include <cmath>
#include <map>
#include <set>
#include <string>

#include "associate_landmarks.hpp"
#include "hmt/graph/chi_squared.hpp"
#include "information.hpp"
#include "landmark_noise.hpp"
#include "landmark_sightings.hpp"
#include "validate_track_options.hpp"

namespace hmt::submap {
namespace {

/// A measurement of a named landmark that contradicts the filter more than this is not learnt from;
/// whether it is wrong is decided later, by all measurements together.
constexpr double kContradiction = 0.9999;
/// Contradictions in a row after which it is the filter that is wrong about a landmark.
constexpr int kMostContradictions = 3;

std::vector<Observation> read_all(LogReader& log, const Run& run) {
  std::vector<Observation> observations;
  while (auto observation = log.next()) {
    if (run.stop_requested()) throw Interrupted{};
    observations.push_back(std::move(*observation));
    if (observations.size() % 1000 == 0)
      run.report(
          {"track", static_cast<double>(log.bytes_read()), static_cast<double>(log.bytes_total())});
  }
  if (observations.empty()) throw InputError("the log holds no observation");
  return observations;
}

double rotation_angle_rad(const Pose& T) {
  return 2 * std::atan2(T.rotation.vec().norm(), std::abs(T.rotation.w()));
}

/// The front end, one observation at a time.
class LandmarkTracker {
 public:
  LandmarkTracker(Space space, const TrackOptions& options, const Pose& T_odom_first)
      : space_(space),
        options_(options),
        filter_(space, T_odom_first),
        T_odom_latest_(T_odom_first),
        dimension_(space == Space::se2 ? 2 : 3),
        contradiction_(graph::chi_squared_quantile(dimension_, kContradiction)) {
    result_.track.space = space;
  }

  void add(const Observation& observation) {
    move(observation);
    if (is_new_keyframe()) begin_keyframe(observation);
    see(observation);
    const int keyframe = result_.track.keyframes.back().id;
    result_.track.observations.push_back(
        {observation.index, observation.stamp_s, keyframe, T_keyframe_robot_});
  }

  int64_t left_out() const { return left_out_; }
  TrackedLog take() {
    result_.names = numbers_.names();
    return std::move(result_);
  }

 private:
  void move(const Observation& observation) {
    const Pose step = graph::relative_pose(T_odom_latest_, observation.T_odom_robot);
    const Matrix6d covariance = observation.motion_covariance.value_or(Matrix6d::Zero());
    T_odom_latest_ = observation.T_odom_robot;
    filter_.predict(step, covariance);
    covariance_keyframe_ = graph::compose_covariance(step, covariance_keyframe_, covariance);
    T_keyframe_robot_ = T_keyframe_robot_ * step;
  }

  bool is_new_keyframe() const {
    if (result_.track.keyframes.empty()) return true;
    if (static_cast<int>(seen_.size()) < dimension_) return false;
    return T_keyframe_robot_.translation.norm() >= options_.keyframe_distance_m ||
           rotation_angle_rad(T_keyframe_robot_) >= options_.keyframe_angle_rad;
  }

  void begin_keyframe(const Observation& observation) {
    Track& track = result_.track;
    const int id = static_cast<int>(track.keyframes.size());
    if (id > 0)
      track.odometry.push_back({id - 1, id, ConstraintKind::odometry, T_keyframe_robot_,
                                inverse_in(space_, covariance_keyframe_)});
    track.keyframes.push_back(
        {id, observation.index, observation.stamp_s, filter_.T_track_robot()});
    T_keyframe_robot_ = Pose{};
    covariance_keyframe_.setZero();
    seen_.clear();
  }

  void see(const Observation& observation) {
    int place = 0;
    for (const LandmarkReading& reading : observation.landmark_readings) {
      std::vector<MeasuredLandmark> measured;
      for (const Landmark& landmark : reading.landmarks)
        measured.push_back(in_robot(reading, landmark));
      const std::vector<int> by_place = associate_landmarks(filter_, measured);
      for (size_t k = 0; k < measured.size(); ++k, ++place)
        if (const int number = learn(reading.landmarks[k].id, by_place[k], measured[k]);
            number >= 0)
          keep(observation.index, place, number, measured[k]);
    }
  }

  /// Number of the landmark in the map, or kLeftOut.
  int learn(int64_t name, int by_place, const MeasuredLandmark& measured) {
    if (name != kUnknownLandmark) return learn_named(numbers_.of(name), measured);
    if (by_place == kLeftOut) {
      ++left_out_;
      return kLeftOut;
    }
    if (by_place >= 0) {
      filter_.update(by_place, measured);
      return by_place;
    }
    const int number = numbers_.add(kUnknownLandmark);
    filter_.insert(number, measured);
    return number;
  }

  int learn_named(int number, const MeasuredLandmark& measured) {
    const auto innovation = filter_.innovation(number, measured);
    int& contradictions = contradictions_[number];
    if (!innovation) {
      filter_.insert(number, measured);
    } else if (innovation->mahalanobis_squared <= contradiction_) {
      filter_.update(number, measured);
      contradictions = 0;
    } else if (++contradictions == kMostContradictions) {
      filter_.forget(number);
      filter_.insert(number, measured);
      contradictions = 0;
    }
    return number;
  }

  void keep(int64_t observation, int place, int number, const MeasuredLandmark& measured) {
    seen_.insert(number);
    Sighting sighting =
        carried_to_keyframe(space_, measured, T_keyframe_robot_, covariance_keyframe_);
    sighting.observation = observation;
    sighting.place = place;
    sighting.keyframe = result_.track.keyframes.back().id;
    sighting.landmark = number;
    result_.sightings.push_back(sighting);
  }

  Space space_;
  TrackOptions options_;
  LandmarkFilter filter_;
  TrackedLog result_;
  LandmarkNumbers numbers_;
  std::map<int, int> contradictions_;
  Pose T_odom_latest_;
  // Since the latest keyframe, by odometry alone.
  Pose T_keyframe_robot_;
  Matrix6d covariance_keyframe_ = Matrix6d::Zero();
  std::set<int> seen_;  ///< from the latest keyframe
  int dimension_;       ///< landmarks that fix a pose, and numbers of a position
  double contradiction_;
  int64_t left_out_ = 0;
};

}  // namespace

TrackedLog track_landmarks(LogReader& log, const TrackOptions& options,
                           const std::function<void(const Observation&)>& keep, const Run& run) {
  validate(options);
  const std::vector<Observation> observations =
      with_noise(read_all(log, run), log.space(), options);
  LandmarkTracker tracker(log.space(), options, observations.front().T_odom_robot);
  for (const Observation& observation : observations) {
    if (run.stop_requested()) throw Interrupted{};
    tracker.add(observation);
    if (keep) keep(observation);
  }
  TrackedLog result = tracker.take();
  result.track.log = log.report();
  if (tracker.left_out() > 0)
    result.track.log.notes["sightings left out: which landmark it is cannot be told"] +=
        tracker.left_out();
  run.log_info(std::to_string(result.sightings.size()) + " sightings of " +
               std::to_string(result.names.size()) + " landmarks from " +
               std::to_string(result.track.keyframes.size()) + " keyframes");
  return result;
}

}  // namespace hmt::submap
