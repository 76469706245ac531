// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#include "keyframe_points.hpp"

#include <algorithm>

namespace hmt::submap {

Pose KeyframePointSource::T_frame_keyframe(int keyframe) const {
  Pose T = T_world_keyframe_[static_cast<size_t>(keyframe)];
  T.translation -= T_world_keyframe_.front().translation;
  return T;
}

std::vector<int> KeyframePointSource::sensors(int keyframe) const {
  std::vector<int> sensors;
  const auto observation =
      observations_.load(keyframes_[static_cast<size_t>(keyframe)].observation);
  for (const Reading& reading : observation->readings) sensors.push_back(reading.sensor);
  return sensors;
}

KeyframePoints KeyframePointSource::points(int keyframe, std::span<const int> sensors) const {
  const auto observation =
      observations_.load(keyframes_[static_cast<size_t>(keyframe)].observation);
  KeyframePoints points(sensors.size());
  for (const Reading& reading : observation->readings) {
    const auto sensor = std::lower_bound(sensors.begin(), sensors.end(), reading.sensor);
    auto& slot = points[static_cast<size_t>(sensor - sensors.begin())];
    if (!slot) slot.emplace(reading, T_frame_keyframe(keyframe), max_mahalanobis_);
  }
  return points;
}

}  // namespace hmt::submap
