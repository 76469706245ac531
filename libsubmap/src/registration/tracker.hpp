// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "hmt/submap/registration/track.hpp"
#include "local_map.hpp"
#include "locate.hpp"
#include "odometry_calibration.hpp"
#include "odometry_model.hpp"
#include "weigh_chain.hpp"

namespace hmt::submap {

/// Where the pose of an observation came from.
struct TrackCounts {
  int64_t registered = 0;
  int64_t searched = 0;       ///< registered after a search around the odometry's guess
  int64_t odometry_only = 0;  ///< nothing to register, or no registration to be trusted
  int64_t odometry_jumps = 0;
  int64_t lost = 0;  ///< without odometry and registered nowhere, so that a guess took its place
};

/// The front end, one observation at a time.
class Tracker {
 public:
  Tracker(Space space, const TrackOptions& options);

  /// `surface`: what the observation saw.
  void add(const Observation& observation, Surface surface);
  const TrackCounts& counts() const { return counts_; }
  /// The one added last.
  const TrackedObservation& latest() const { return track_.observations.back(); }
  /// Of its T_keyframe_robot, by registration and odometry (tangent of Pose, frame of the robot).
  Matrix6d covariance_keyframe_robot() const;
  /// Everything but the log report, at the end of the log.
  Track take();

 private:
  struct Estimate {
    Pose T_track_robot;
    Matrix6d information = Matrix6d::Zero();  // of the registration alone
    bool registered = false;
    Pose T_track_measured;  // what the surfaces alone say, without the prediction
  };

  /// A step between two observations.
  struct Motion {
    Pose odometry;  ///< as the log has it
    Pose step;      ///< what is believed of it
    Matrix6d covariance = Matrix6d::Zero();
    double duration_s = 0;
    bool by_odometry = false;  ///< otherwise nothing is to be learnt about it
  };

  Estimate estimate(const Surface& surface, const Prediction& prediction);
  void start(const Observation& observation, Surface surface);
  /// The robot's motion since the latest observation, before its surfaces are looked at.
  Motion predict_step(const Observation& observation);
  /// Whether an observation becomes a keyframe. One that is lost does, and starts a new local map.
  bool is_keyframe(const Estimate& estimate);
  /// What a registration tells of the odometry.
  void learn_odometry(const Motion& motion, const Prediction& prediction, const Estimate& found);
  void add_keyframe(const Observation& observation, const Estimate& estimate, Surface surface);

  Space space_;
  TrackOptions options_;
  // Between observations a clock's jitter counts, which is gone between keyframes.
  OdometryCalibration calibration_;
  OdometryModel step_odometry_;
  OdometryModel keyframe_odometry_;
  // Until the odometry moves for the first time, which in a log without any it never does: the
  // robot goes on as it went.
  OdometryModel steady_;
  bool odometry_moves_ = false;
  Pose latest_step_;
  double latest_duration_s_ = 0;
  LocalMap map_;
  Track track_;
  TrackCounts counts_;
  std::vector<ChainStep> chain_;  // in space, one a step between keyframes

  // The latest observation.
  double stamp_latest_s_ = 0;
  Pose T_odom_latest_;
  Pose T_track_latest_;
  Matrix6d covariance_latest_ = Matrix6d::Zero();   // against the local map
  Matrix6d information_latest_ = Matrix6d::Zero();  // of its registration
  // Since the latest keyframe, by odometry alone.
  Pose T_keyframe_odometry_;
  Matrix6d information_keyframe_ = Matrix6d::Zero();  // of its registration
  bool odometry_unbroken_ = true;
  int refused_ = 0;  // observations in a row whose registration was not taken
};

}  // namespace hmt::submap
