// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "hmt/submap/registration/sighting.hpp"
#include "hmt/submap/registration/track.hpp"
#include "landmark_filter.hpp"
#include "landmark_noise.hpp"

namespace hmt::submap {

/// The landmarks of a map: one for each name, in the order in which they are seen first.
class LandmarkNumbers {
 public:
  /// Number of the landmark of that name.
  int of(int64_t name);
  /// Number of a landmark that was not there.
  int add(int64_t name);
  /// By number.
  const std::vector<int64_t>& names() const { return names_; }

 private:
  std::map<int64_t, int> number_of_;
  std::vector<int64_t> names_;
};

/// The landmark in the frame of the robot.
MeasuredLandmark in_robot(const LandmarkReading& reading, const Landmark& landmark);

/// The measurement as a sighting from the keyframe that its observation hangs on, but for the
/// numbers: its place moves with the pose of the robot against the keyframe (tangent of Pose, frame
/// of the robot), and with its own noise.
Sighting carried_to_keyframe(Space space, const MeasuredLandmark& measured,
                             const Pose& T_keyframe_robot, const Matrix6d& covariance);

/// The sightings of named landmarks along a track that the range sensors find. Sightings of which
/// the log does not tell the covariance have an ordinary one, those of one view together that of
/// one. Memory grows with the sightings.
class LandmarkSightings {
 public:
  LandmarkSightings(Space space, const TrackOptions& options) : space_(space), views_(options) {}

  /// The landmarks of an observation; `covariance`: of its T_keyframe_robot.
  void add(const Observation& observation, const TrackedObservation& tracked,
           const Matrix6d& covariance);
  /// Landmarks without a name: without them no one can tell which is which.
  int64_t unnamed() const { return unnamed_; }
  const std::vector<int64_t>& names() const { return numbers_.names(); }
  /// All of them, in the order of the log.
  std::vector<Sighting> take();

 private:
  struct Seen {
    Sighting sighting;  ///< without information
    /// Of its place by the landmark's own noise and by that of the pose, frame of the keyframe.
    Eigen::Matrix3d measured, carried;
    size_t view = 0;
    bool is_told = false;
  };

  Space space_;
  LandmarkNumbers numbers_;
  LandmarkViews views_;
  std::vector<Seen> seen_;
  int64_t unnamed_ = 0;
};

}  // namespace hmt::submap
