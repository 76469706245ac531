// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "keyframe_space.hpp"

#include <algorithm>

namespace hmt::submap {

Pose KeyframeSpaceSource::T_frame_keyframe(int keyframe) const {
  Pose T = T_world_keyframe_[static_cast<size_t>(keyframe)];
  T.translation -= T_world_keyframe_.front().translation;
  return T;
}

std::vector<Sensor> KeyframeSpaceSource::sensors(int keyframe) const {
  std::vector<Sensor> sensors;
  const auto observation =
      observations_.load(keyframes_[static_cast<size_t>(keyframe)].observation);
  for (const Reading& r : observation->readings) sensors.push_back({SensorKind::range, r.sensor});
  for (const LandmarkReading& r : observation->landmark_readings) {
    sensors.push_back({SensorKind::landmarks, r.sensor});
  }
  return sensors;
}

KeyframeSpace KeyframeSpaceSource::space(int keyframe, std::span<const Sensor> sensors) const {
  const auto observation =
      observations_.load(keyframes_[static_cast<size_t>(keyframe)].observation);
  const Pose T = T_frame_keyframe(keyframe);
  KeyframeSpace space(sensors.size());
  const auto slot = [&](const Sensor& sensor) -> SensedReading& {
    const auto found = std::lower_bound(sensors.begin(), sensors.end(), sensor);
    return space[static_cast<size_t>(found - sensors.begin())];
  };
  for (const Reading& reading : observation->readings) {
    SensedReading& sensed = slot({SensorKind::range, reading.sensor});
    if (sensed.index() == 0) sensed.emplace<SensedPoints>(reading, T, options_.max_mahalanobis);
  }
  for (const LandmarkReading& reading : observation->landmark_readings) {
    SensedReading& sensed = slot({SensorKind::landmarks, reading.sensor});
    if (sensed.index() == 0) sensed.emplace<SensedLandmarks>(reading, T, options_);
  }
  return space;
}

}  // namespace hmt::submap
