// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "keyframe_space.hpp"

#include <algorithm>
#include <map>

namespace hmt::submap {

std::vector<SensorUse> sensors_of(std::span<const std::vector<Sight>> keyframes) {
  struct Total {
    double points = 0;
    double readings = 0;
    bool cloud = false;
  };
  std::map<Sensor, Total> totals;
  for (const auto& sights : keyframes) {
    for (const auto& [sensor, points, cloud] : sights) {
      totals[sensor].points += static_cast<double>(points);
      totals[sensor].readings += 1;
      totals[sensor].cloud = totals[sensor].cloud || cloud;
    }
  }
  std::vector<SensorUse> sensors;
  for (const auto& [sensor, total] : totals) {
    const double most = total.cloud ? kMaxExactCloud : kMaxExactPoints;
    sensors.push_back({sensor, total.points > most * total.readings});
  }
  return sensors;
}

Pose KeyframeSpaceSource::T_frame_keyframe(int keyframe) const {
  Pose T = T_world_keyframe_[static_cast<size_t>(keyframe)];
  T.translation -= T_world_keyframe_.front().translation;
  return T;
}

std::vector<Sight> KeyframeSpaceSource::sights(int keyframe) const {
  std::vector<Sight> sights;
  const auto observation =
      observations_.load(keyframes_[static_cast<size_t>(keyframe)].observation);
  for (const Reading& r : observation->readings) {
    sights.push_back({{SensorKind::range, r.sensor}, r.points_sensor.size(), is_cloud(r)});
  }
  for (const LandmarkReading& r : observation->landmark_readings) {
    sights.push_back({{SensorKind::landmarks, r.sensor}, 0, false});
  }
  return sights;
}

KeyframeSpace KeyframeSpaceSource::space(int keyframe, std::span<const SensorUse> sensors) const {
  const auto observation =
      observations_.load(keyframes_[static_cast<size_t>(keyframe)].observation);
  const Pose T = T_frame_keyframe(keyframe);
  KeyframeSpace space(sensors.size());
  const auto slot_of = [&](const Sensor& sensor) {
    const auto found = std::lower_bound(
        sensors.begin(), sensors.end(), sensor,
        [](const SensorUse& use, const Sensor& wanted) { return use.sensor < wanted; });
    return static_cast<size_t>(found - sensors.begin());
  };
  for (const Reading& reading : observation->readings) {
    const size_t slot = slot_of({SensorKind::range, reading.sensor});
    if (space[slot].index() != 0) continue;
    if (sensors[slot].by_voxels) {
      space[slot].emplace<SensedVoxels>(reading, T);
    } else {
      space[slot].emplace<SensedPoints>(reading, T, options_.max_mahalanobis);
    }
  }
  for (const LandmarkReading& reading : observation->landmark_readings) {
    SensedReading& sensed = space[slot_of({SensorKind::landmarks, reading.sensor})];
    if (sensed.index() == 0) sensed.emplace<SensedLandmarks>(reading, T, options_);
  }
  return space;
}

}  // namespace hmt::submap
