// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "landmark_sights.hpp"

#include <algorithm>

namespace hmt::submap {
namespace {

/// More than any camera sends while the robot waits for its next scan.
constexpr size_t kMostSights = 10000;
/// Over a longer time odometry is no better than what the scans tell.
constexpr uint64_t kLongest_ns = 1'000'000'000;

}  // namespace

bool LandmarkSights::add(LandmarkSight sight) {
  const bool is_full = sights_.size() == kMostSights;
  if (is_full) sights_.pop_front();
  sights_.push_back(std::move(sight));
  return !is_full;
}

LandmarkSight LandmarkSights::pop() {
  LandmarkSight sight = std::move(sights_.front());
  sights_.pop_front();
  return sight;
}

LandmarkSights::Taken LandmarkSights::take(const Pose& T_odom_robot, int64_t stamp_ns,
                                           std::optional<int64_t> next_stamp_ns,
                                           const PoseHistory& odometry, Space space) {
  const auto is_later = [&](const LandmarkSight& sight) {
    return next_stamp_ns && stamp_distance(sight.stamp_ns, *next_stamp_ns) <
                                stamp_distance(sight.stamp_ns, stamp_ns);
  };
  std::vector<LandmarkSight> here;
  std::deque<LandmarkSight> later;
  for (LandmarkSight& sight : sights_) {
    if (is_later(sight))
      later.push_back(std::move(sight));
    else
      here.push_back(std::move(sight));
  }
  sights_ = std::move(later);
  std::ranges::stable_sort(
      here, {}, [](const LandmarkSight& sight) { return std::pair(sight.stamp_ns, sight.sensor); });
  Taken taken;
  for (const LandmarkSight& sight : here) {
    const auto T_odom_then = odometry.at(sight.stamp_ns);
    if (stamp_distance(sight.stamp_ns, stamp_ns) > kLongest_ns)
      ++taken.too_far;
    else if (!T_odom_then)
      ++taken.without_odometry;
    else
      taken.readings.push_back(as_reading(sight, relative_pose(T_odom_robot, *T_odom_then), space));
  }
  return taken;
}

LandmarkReading as_reading(const LandmarkSight& sight, const Pose& T_robot_then, Space space) {
  const Pose& mount = sight.T_robot_sensor;
  const bool is_planar = space == Space::se2;
  LandmarkReading reading;
  reading.sensor = sight.sensor;
  reading.T_robot_sensor =
      T_robot_then *
      (is_planar ? Pose::planar(mount.translation.x(), mount.translation.y(), 0) : mount);
  for (const Marker& marker : sight.markers) {
    Landmark landmark;
    landmark.id = marker.name;
    landmark.position_sensor = marker.position;
    landmark.covariance_sensor = marker.covariance;
    if (is_planar) {
      const Eigen::Matrix3d R = mount.rotation_matrix();
      landmark.position_sensor = R * marker.position;
      landmark.position_sensor.z() = 0;
      landmark.covariance_sensor = R * marker.covariance * R.transpose();
      landmark.covariance_sensor.row(2).setZero();
      landmark.covariance_sensor.col(2).setZero();
    }
    reading.landmarks.push_back(landmark);
  }
  return reading;
}

}  // namespace hmt::submap
