// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <span>
#include <variant>
#include <vector>

#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "sensed_landmarks.hpp"
#include "sensed_points.hpp"

namespace hmt::submap {

enum class SensorKind { range, landmarks };

/// A sensor of the log.
struct Sensor {
  SensorKind kind = SensorKind::range;
  int number = 0;

  auto operator<=>(const Sensor&) const = default;
};

/// What one sensor sensed at a keyframe; nothing where it has no reading.
using SensedReading = std::variant<std::monostate, SensedPoints, SensedLandmarks>;
/// One for each sensor of the log.
using KeyframeSpace = std::vector<SensedReading>;

/// Prepares keyframes for matching, in one common frame.
class KeyframeSpaceSource {
 public:
  KeyframeSpaceSource(std::span<const Keyframe> keyframes, std::span<const Pose> T_world_keyframe,
                      const ObservationStore& observations, const OverlapOptions& options)
      : keyframes_(keyframes),
        T_world_keyframe_(T_world_keyframe),
        observations_(observations),
        options_(options) {}

  int num_keyframes() const { return static_cast<int>(keyframes_.size()); }
  /// Points are held as floats, so the common frame is the world moved to the first keyframe.
  Pose T_frame_keyframe(int keyframe) const;
  /// The sensors that a keyframe has readings of, in its own order.
  std::vector<Sensor> sensors(int keyframe) const;
  /// Of several readings of one sensor the first counts. `sensors`: all of the log, sorted.
  KeyframeSpace space(int keyframe, std::span<const Sensor> sensors) const;

 private:
  std::span<const Keyframe> keyframes_;
  std::span<const Pose> T_world_keyframe_;
  const ObservationStore& observations_;
  const OverlapOptions& options_;
};

}  // namespace hmt::submap
