// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <span>

#include "hmt/submap/observation/observation_store.hpp"
#include "hmt/submap/registration/sighting.hpp"
#include "hmt/submap/registration/track.hpp"

namespace hmt::submap {

/// What keyframes saw, as observations: the scans of their own, and of each landmark the mean of
/// all sightings that hang on the keyframe, weighted by information, as one reading in the frame of
/// the robot. A sensor that sees one landmark at a time says little in one observation, and enough
/// on the way to the next keyframe. A landmark bears the number that it has in the map where the
/// log names it, and none elsewhere. Landmarks are held in memory.
///
/// Beside scans landmarks are few, and a keyframe that saw none has no reading of them: that the
/// next one did see a marker tells nothing about the space that they share.
class KeyframeLandmarks : public ObservationStore {
 public:
  /// `names` as in HybridMap::landmark_names; `observations`: of the log, must outlive this.
  KeyframeLandmarks(const Track& track, std::span<const Sighting> sightings,
                    std::span<const int64_t> names, const ObservationStore& observations);
  /// By the index of the keyframe's observation; throws InputError for another.
  std::shared_ptr<const Observation> load(int64_t index) const override;

 private:
  const ObservationStore& observations_;
  std::map<int64_t, LandmarkReading> by_observation_;
};

}  // namespace hmt::submap
