// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/overlap/overlap.hpp"
#include "sensed_points.hpp"

namespace hmt::submap {

/// The points of one keyframe, one slot for each sensor of the log; nothing where it has no reading
/// of that sensor.
using KeyframePoints = std::vector<std::optional<SensedPoints>>;

/// Prepares keyframes for matching, in one common frame.
class KeyframePointSource {
 public:
  KeyframePointSource(std::span<const Keyframe> keyframes, std::span<const Pose> T_world_keyframe,
                      const ObservationStore& observations, const OverlapOptions& options)
      : keyframes_(keyframes),
        T_world_keyframe_(T_world_keyframe),
        observations_(observations),
        max_mahalanobis_(options.max_mahalanobis) {}

  int num_keyframes() const { return static_cast<int>(keyframes_.size()); }
  /// Points are held as floats, so the common frame is the world moved to the first keyframe.
  Pose T_frame_keyframe(int keyframe) const;
  /// The sensor numbers that occur in a keyframe, in its own order.
  std::vector<int> sensors(int keyframe) const;
  /// Of several readings of one sensor the first counts. `sensors`: by increasing number.
  KeyframePoints points(int keyframe, std::span<const int> sensors) const;

 private:
  std::span<const Keyframe> keyframes_;
  std::span<const Pose> T_world_keyframe_;
  const ObservationStore& observations_;
  double max_mahalanobis_ = 0;
};

}  // namespace hmt::submap
