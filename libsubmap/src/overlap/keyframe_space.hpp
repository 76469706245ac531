// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "sensed_landmarks.hpp"
#include "sensed_points.hpp"
#include "sensed_voxels.hpp"

namespace hmt::submap {

enum class SensorKind { range, landmarks };

/// A sensor of the log.
struct Sensor {
  SensorKind kind = SensorKind::range;
  int number = 0;

  bool operator==(const Sensor&) const = default;
  bool operator<(const Sensor& other) const {
    return std::pair(kind, number) < std::pair(other.kind, other.number);
  }
};

/// A sensor that a keyframe has a reading of, and the points in it.
struct Sight {
  Sensor sensor;
  size_t points = 0;
  bool cloud = false;
};

/// A sensor of the log and what its readings are compared by.
struct SensorUse {
  Sensor sensor;
  bool by_voxels = false;  ///< a range sensor of large clouds
};

/// All sensors of the log, sorted, from those of each keyframe. Range sensors with more than
/// kMaxExactPoints a reading on average, of clouds kMaxExactCloud, are compared by voxels.
std::vector<SensorUse> sensors_of(std::span<const std::vector<Sight>> keyframes);

/// What one sensor sensed at a keyframe; nothing where it has no reading.
using SensedReading = std::variant<std::monostate, SensedPoints, SensedVoxels, SensedLandmarks>;
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
  /// All of the keyframe, in its own order.
  std::vector<Sight> sights(int keyframe) const;
  /// Of several readings of one sensor the first counts. `sensors`: all of the log, sorted.
  KeyframeSpace space(int keyframe, std::span<const SensorUse> sensors) const;

 private:
  std::span<const Keyframe> keyframes_;
  std::span<const Pose> T_world_keyframe_;
  const ObservationStore& observations_;
  const OverlapOptions& options_;
};

}  // namespace hmt::submap
