// SPDX-FileCopyrightText: 2026 The hmtmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "cell_index.hpp"
#include "match_bounds.hpp"
#include "sensed_landmarks.hpp"

namespace hmt::submap {

/// What the index keeps of one landmark.
struct LandmarkPlace {
  int64_t id = kUnknownLandmark;
  SensedPoint place;  ///< its gate holds what the pose may move it by besides the common limit
};

/// The places of the landmarks of a reading, in its order.
std::vector<LandmarkPlace> landmark_places(const SensedLandmarks& landmarks,
                                           const OverlapOptions& options);

/// Bounds from above how many landmarks of readings of one sensor can match, without looking at
/// pairs that have neither a name nor a place in common: an inverted index from names, and one from
/// cells where some landmark has no name, to the readings.
class LandmarkIndex {
 public:
  /// `readings[i]`: the landmarks of reading i, none where there is no reading.
  LandmarkIndex(const std::vector<std::vector<LandmarkPlace>>& readings,
                const OverlapOptions& options);

  /// Adds the landmarks of the reading that can match one of the others.
  void add_matches(int reading, BoundSum& sum) const;

 private:
  std::vector<std::vector<int64_t>> names_;               ///< of each reading
  std::map<int64_t, std::vector<ReadingRun>> with_name_;  ///< the readings that a name occurs in
  bool has_unnamed_ = false;
  CellIndex cells_;  ///< of all landmarks, if some have no name
};

}  // namespace hmt::submap
